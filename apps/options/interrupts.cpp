#include "options/interrupts.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>

namespace pellucid::cli {
namespace {

// A handler may hardly do more than write to a pipe; a thread reads it.
int pipe_ends[2] = {-1, -1};

void report_signal(int number) {
    const int before = errno;
    const auto byte = static_cast<unsigned char>(number);
    [[maybe_unused]] const auto written = write(pipe_ends[1], &byte, 1);
    errno = before;
}

/// Leaves signals alone that the parent has chosen to ignore, as nohup does.
void handle(int number) {
    struct sigaction action {};
    if (sigaction(number, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) return;
    action = {};
    action.sa_handler = &report_signal;
    action.sa_flags = SA_RESTART | int(SA_RESETHAND);
    sigaction(number, &action, nullptr);
}

/// Removes files that write_file_atomically() is writing: this process has them open by their temporary names.
void remove_unfinished_files() {
    namespace fs = std::filesystem;
    const std::string mark = fmt::format(".part-{}-", getpid());
    std::error_code error;
    for (const auto& open : fs::directory_iterator("/proc/self/fd", error)) {
        const fs::path file = fs::read_symlink(open.path(), error);
        if (!error && file.filename().string().find(mark) != std::string::npos) fs::remove(file, error);
    }
}

void end_at_signal() {
    unsigned char number = 0;
    while (read(pipe_ends[0], &number, 1) < 0 && errno == EINTR) {
    }
    if (number == 0) return;  // the program ends by itself
    remove_unfinished_files();
    const char* const line = isatty(STDERR_FILENO) == 1 ? "\r\x1b[K" : "";  // the progress bar's
    std::fputs(fmt::format("{}pellucid: ended by {}; finished files stay\n", line,
                           number == SIGINT ? "an interrupt (SIGINT)" : "SIGTERM")
                   .c_str(),
               stderr);
    signal(number, SIG_DFL);
    kill(getpid(), number);
}

}  // namespace

Interrupts::Interrupts() {
    if (pipe2(pipe_ends, O_CLOEXEC) != 0) return;
    waiting_ = std::thread(&end_at_signal);
    handle(SIGINT);
    handle(SIGTERM);
}

Interrupts::~Interrupts() {
    if (!waiting_.joinable()) return;
    report_signal(0);
    waiting_.join();
}

}  // namespace pellucid::cli
