#pragma once

#include <thread>

namespace pellucid::cli {

/// Ends the program at SIGINT and SIGTERM as a shell expects it (exit codes 130 and 143), after removing files that are
/// half written. Finished files stay. A second signal ends it at once.
class Interrupts {
public:
    Interrupts();
    ~Interrupts();
    Interrupts(const Interrupts&) = delete;
    Interrupts& operator=(const Interrupts&) = delete;

private:
    std::thread waiting_;
};

}  // namespace pellucid::cli
