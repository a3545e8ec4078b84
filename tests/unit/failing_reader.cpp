// A program for ReaderProgram that fails as its request says.
#include "core/read_apart.h"

#include <pellucid/error.h>

#include <sched.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>
#include <vector>

namespace pellucid {
namespace {

std::vector<std::byte> fail_as_asked(std::span<const std::byte> request) {
    const std::string how(reinterpret_cast<const char*>(request.data()), request.size());
    if (how == "crash") raise(SIGSEGV);
    if (how == "abort") std::abort();
    if (how == "exit") _exit(0);
    if (how == "throw") throw Error("a.png: is bad");
    if (how == "memory") return std::vector<std::byte>(std::size_t(1) << 40);
    if (how == "large") return std::vector<std::byte>(std::size_t(1) << 24);
    if (how == "pid") {
        const pid_t program = getppid();
        const auto bytes = std::as_bytes(std::span(&program, 1));
        return {bytes.begin(), bytes.end()};
    }
    if (how == "kill") {
        const pid_t program = getppid();
        kill(program, SIGKILL);
        while (getppid() == program) sched_yield();
        std::abort();
    }
    return {request.begin(), request.end()};
}

}  // namespace
}  // namespace pellucid

int main() { pellucid::serve_readers(std::array{pellucid::ServedReader{pellucid::fail_as_asked}}); }
