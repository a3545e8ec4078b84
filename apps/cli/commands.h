#pragma once

#include <CLI/CLI.hpp>

namespace pellucid::cli {

/// Add a subcommand with its options; it runs as the callback of the parse. Errors are thrown.
void add_render_command(CLI::App& app);
void add_thickness_command(CLI::App& app);
void add_volume_command(CLI::App& app);
void add_info_command(CLI::App& app);
void add_techniques_command(CLI::App& app);
/// The last one: it describes those that were added before.
void add_help_command(CLI::App& app);

}  // namespace pellucid::cli
