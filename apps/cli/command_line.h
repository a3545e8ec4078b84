#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace pellucid::cli {

/// All commands. `command_line`: as typed, for reports.
void add_commands(CLI::App& app, const std::string& command_line);

/// Parses the arguments and runs the command. Throws what the parser and the command throw.
void parse_arguments(CLI::App& app, int argc, char** argv);

/// An error of the parser in one line, with the option that may have been meant, and where to read on.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv);

}  // namespace pellucid::cli
