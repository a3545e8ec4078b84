#include "core/read_apart.h"

#include "core/fail.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <string_view>

namespace pellucid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "pellucid-reader";

fs::path own_program() {
    // Beside the library; or, of a program that has the library inside, where the build puts libraries.
    const std::array<fs::path, 2> files = {own_folder() / kProgram, own_folder().parent_path() / "lib" / kProgram};
    std::error_code error;
    return fs::exists(files[0], error) ? files[0] : files[1];
}

bool reads_here() {
    const char* const apart = std::getenv("PELLUCID_READ_APART");
    return apart && std::string_view(apart) == "0";
}

}  // namespace

fs::path own_folder() {
    Dl_info info{};
    dladdr(reinterpret_cast<const void*>(&own_folder), &info);
    std::error_code error;
    const fs::path file = info.dli_fname ? info.dli_fname : "";
    const fs::path resolved = fs::canonical(file, error);
    return (error ? file : resolved).parent_path();
}

/// A socket to a new process of the program.
Descriptor ReaderProgram::connect(ApartKind kind) {
    auto [ours, theirs] = socket_pair(SOCK_STREAM);
    const std::lock_guard lock(mutex_);
    // A program that has ended is started again, once.
    for (int attempt = 0; attempt < 2; ++attempt) {
        if (control_.get() < 0 || attempt > 0) control_ = start();
        if (send_descriptor(control_.get(), theirs.get(), std::uint8_t(kind))) return std::move(ours);
    }
    fail(program_, "does not run; without it no image, 3DS or VDB file is read");
}

Descriptor ReaderProgram::start() const {
    auto [ours, theirs] = socket_pair(SOCK_SEQPACKET);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, theirs.get(), kReaderSocket);
    std::string name = program_.string();
    std::array<char*, 2> arguments = {name.data(), nullptr};
    pid_t child = 0;
    const int error = posix_spawn(&child, name.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0)
        fail(program_,
             fmt::format("cannot be started ({}); without it no image, 3DS or VDB file is read", std::strerror(error)));
    while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }  // the program goes on as a process of its own
    return std::move(ours);
}

std::vector<std::byte> ReaderProgram::read(ApartKind kind, std::span<const std::byte> request, std::uint64_t most_bytes,
                                           const fs::path& file) {
    const Descriptor socket = connect(kind);
    std::error_code error;
    const std::string folder = fs::current_path(error).string();  // the file's name may be relative to it
    const ApartHead head{.most_bytes = most_bytes, .folder_size = folder.size(), .size = request.size()};
    ApartReply reply{};
    const bool answered =
        write_all(socket.get(), &head, sizeof head) && write_all(socket.get(), folder.data(), folder.size()) &&
        write_all(socket.get(), request.data(), request.size()) && read_all(socket.get(), &reply, sizeof reply);
    if (!answered) fail(file, "its reader crashed, or took more memory or time than it may: the file is damaged");
    if (reply.result == ApartResult::kOutOfMemory || reply.size > std::max(most_bytes, most_bytes + kApartSlack))
        fail(file, "needs more memory than a scene may take");
    std::vector<std::byte> result(reply.size);
    if (!read_all(socket.get(), result.data(), result.size())) fail(file, "its reader crashed: the file is damaged");
    if (reply.result != ApartResult::kDone)
        throw Error(one_line(std::string(reinterpret_cast<const char*>(result.data()), result.size())));
    return result;
}

std::vector<std::byte> read_apart(ApartKind kind, ApartReader reader, std::span<const std::byte> request,
                                  std::uint64_t most_bytes, const fs::path& file) {
    static ReaderProgram program(own_program());
    return reads_here() ? reader(request) : program.read(kind, request, most_bytes, file);
}

}  // namespace pellucid
