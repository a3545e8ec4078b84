#pragma once

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace pellucid::cli {

/// How much a command reports beside its results: warnings and progress; nothing but errors with --quiet; with --verbose
/// also what was done, and how long it took.
struct Console {
    bool quiet = false;
    bool verbose = false;

    /// fmt::print(), as for the lines of a table; nothing with --quiet.
    template <class... Arguments>
    void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
        if (quiet) return;
        fmt::print(format, std::forward<Arguments>(arguments)...);
        std::fflush(stdout);
    }
    /// One line each on stderr; none with --quiet.
    void warn(const std::vector<std::string>& warnings) const;
    /// "pellucid: TEXT" on stderr with --verbose.
    void report(const std::string& text) const;
};
void add_console_options(CLI::App& command, Console& console);

}  // namespace pellucid::cli
