#include "core/file_scope.h"

#include "core/fail.h"

#include <system_error>

namespace pellucid {
namespace {

namespace fs = std::filesystem;

fs::path resolved(const fs::path& path, std::error_code& error) {
    // Of a relative path that does not exist, weakly_canonical() alone makes no absolute one.
    const fs::path absolute = fs::absolute(path.empty() ? fs::path(".") : path, error);
    return error ? path : fs::weakly_canonical(absolute, error);
}

}  // namespace

bool FileScope::contains(const fs::path& file) const {
    if (allow_outside) return true;
    std::error_code error;
    const fs::path from = resolved(folder, error), to = resolved(file, error);
    if (error) return true;  // such a path cannot be opened either
    const fs::path relative = to.lexically_relative(from);
    return !relative.empty() && *relative.begin() != "..";
}

void FileScope::check(const fs::path& file) const {
    if (!contains(file)) fail(file, kOutsideScope);
}

}  // namespace pellucid
