#include "sequence/frame_claims.h"

#include "sequence/frames.h"

#include <pellucid/error.h>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <set>
#include <string>
#include <system_error>

namespace pellucid::sequence {

FrameClaims::FrameClaims(const std::filesystem::path& file)
    : path_(file), file_(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    if (file_ < 0) throw Error(fmt::format("{}: cannot write: {}", file.string(), std::strerror(errno)));
}

FrameClaims::~FrameClaims() { close(file_); }

bool FrameClaims::claim(long frame) { return lock(F_OFD_SETLK, F_WRLCK, frame); }

void FrameClaims::claim_in_turn(long frame) { lock(F_OFD_SETLKW, F_WRLCK, frame); }

void FrameClaims::release(long frame) { lock(F_OFD_SETLK, F_UNLCK, frame); }

bool FrameClaims::lock(int command, short type, long frame) {
    struct flock range {};
    range.l_type = type;
    range.l_whence = SEEK_SET;
    range.l_start = frame;
    range.l_len = 1;
    int result = 0;
    do {
        result = fcntl(file_, command, &range);
    } while (result != 0 && errno == EINTR);
    if (result == 0) return true;
    if (errno == EAGAIN || errno == EACCES) return false;
    has_locks_ = false;
    return true;
}

void remove_leftovers(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& files) {
    std::set<std::string> written;
    for (const std::filesystem::path& file : files)
        if (is_written(file)) written.insert(file.filename().string());
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder, error)) {
        // ".NAME.part-...EXTENSION", as write_file_atomically() names them
        const std::string name = entry.path().filename().string();
        const std::size_t part = name.rfind(".part-");
        if (name.front() != '.' || part == std::string::npos || part == 0) continue;
        if (written.contains(name.substr(1, part - 1) + entry.path().extension().string()))
            std::filesystem::remove(entry.path(), error);
    }
}

}  // namespace pellucid::sequence
