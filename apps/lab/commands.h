#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace pellucid::cli {

/// Each function adds a subcommand with its options; the subcommand runs as the callback of the parse. Errors are
/// thrown. `command_line`: as typed, for the report.
void add_compare_command(CLI::App& app, const std::string& command_line);
void add_bench_command(CLI::App& app);
void add_experiment_command(CLI::App& app);
void add_difference_command(CLI::App& app);
void add_dataset_command(CLI::App& app);

}  // namespace pellucid::cli
