#include "core/image_module.h"

#include "core/read_apart.h"

#include <pellucid/error.h>

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <filesystem>

namespace pellucid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = "libpellucid_images.so";

const ImageModule& load() {
    // Beside the library; or, of a program that has the library inside, where the build puts libraries.
    const std::array<fs::path, 2> files = {own_folder() / kFile, own_folder().parent_path() / "lib" / kFile};
    std::error_code error;
    const fs::path& file = fs::exists(files[0], error) ? files[0] : files[1];
    void* const library = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
    const void* const module = library ? dlsym(library, kImageModuleSymbol) : nullptr;
    if (!module) throw Error(fmt::format("images cannot be read or written: {}", one_line(dlerror())));
    return *static_cast<const ImageModule*>(module);
}

}  // namespace

const ImageModule& image_module() {
    static const ImageModule& module = load();
    return module;
}

void load_image_module() {
    try {
        image_module();
    } catch (const Error&) {
    }
}

}  // namespace pellucid
