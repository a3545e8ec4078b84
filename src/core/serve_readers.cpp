// The other side of read_apart.cpp: one process for each request.
#include "core/pipes.h"
#include "core/read_apart.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <new>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace pellucid {
namespace {

constexpr std::uint64_t kThreadBytes = std::uint64_t(160) << 20;  // addresses for stack and heap of a thread
constexpr rlim_t kMostSeconds = 600;                              // of processor time, for one file
constexpr std::uint64_t kWorkBytes = std::uint64_t(1) << 28;      // of a library, beside the result

void set_limit(int resource, rlim_t value) {
    rlimit limit{};
    getrlimit(__rlimit_resource_t(resource), &limit);
    limit.rlim_cur = std::min(value, limit.rlim_max);
    setrlimit(__rlimit_resource_t(resource), &limit);
}

/// Addresses that this process has mapped, libraries included.
std::uint64_t mapped_bytes() {
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * std::uint64_t(sysconf(_SC_PAGESIZE));
}

void limit_resources(std::uint64_t most_bytes) {
    // The result is there twice when it is sent.
    const std::uint64_t base = mapped_bytes() + kWorkBytes + kThreadBytes * std::thread::hardware_concurrency();
    if (most_bytes < (RLIM_INFINITY - base) / 2) set_limit(RLIMIT_AS, base + 2 * most_bytes);
    set_limit(RLIMIT_CPU, kMostSeconds);
    set_limit(RLIMIT_CORE, 0);
}

void answer(int socket, ApartResult result, const void* data, std::size_t size) {
    const ApartReply reply{.result = result, .size = size};
    if (write_all(socket, &reply, sizeof reply)) write_all(socket, data, size);
}

void read_one(ApartReader reader, int socket) {
    ApartHead head{};
    if (!read_all(socket, &head, sizeof head)) return;
    try {
        std::string folder(head.folder_size, '\0');
        std::vector<std::byte> request(head.size);
        if (!read_all(socket, folder.data(), folder.size()) || !read_all(socket, request.data(), request.size()))
            return;
        if (!folder.empty() && chdir(folder.c_str()) != 0) return;
        limit_resources(head.most_bytes);
        const std::vector<std::byte> result = reader(request);
        answer(socket, ApartResult::kDone, result.data(), result.size());
    } catch (const std::bad_alloc&) {
        answer(socket, ApartResult::kOutOfMemory, nullptr, 0);
    } catch (const std::exception& error) {
        const std::string cause = error.what();
        answer(socket, ApartResult::kRefused, cause.data(), cause.size());
    }
}

/// Leaves the process that started this program, and all that it has open.
void detach() {
    if (fork() != 0) _exit(0);  // the process that waits for this one goes on
    setsid();                   // signals of the terminal are for the program that renders
    const int nowhere = open("/dev/null", O_RDWR);
    for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
    close_range(kReaderSocket + 1, ~0u, 0);
}

}  // namespace

void serve_readers(std::span<const ServedReader> readers) {
    detach();
    std::signal(SIGCHLD, SIG_IGN);  // nobody waits for the processes
    std::vector<char> prepared(readers.size(), 0);
    for (;;) {
        std::uint8_t kind = 0;
        const Descriptor socket = receive_descriptor(kReaderSocket, kind);
        // Destructors of libraries would wait for threads that fork() has left behind.
        if (socket.get() < 0 || kind >= readers.size()) _exit(0);
        const ServedReader& reader = readers[kind];
        if (reader.prepare && !std::exchange(prepared[kind], 1)) reader.prepare();
        if (fork() != 0) continue;
        close(kReaderSocket);
        read_one(reader.read, socket.get());
        _exit(0);
    }
}

}  // namespace pellucid
