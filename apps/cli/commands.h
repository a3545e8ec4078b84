#pragma once

#include <CLI/CLI.hpp>

#include <stdexcept>

namespace pellucid::cli {

/// Frames of a sequence are missing: exit code 4.
struct FramesMissing : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Add a subcommand with its options; it runs as the callback of the parse. Errors are thrown.
void add_render_command(CLI::App& app);
void add_sequence_command(CLI::App& app);
void add_thickness_command(CLI::App& app);
void add_volume_command(CLI::App& app);
void add_export_command(CLI::App& app);
void add_info_command(CLI::App& app);
void add_techniques_command(CLI::App& app);
/// The last one: it describes those that were added before.
void add_help_command(CLI::App& app);

}  // namespace pellucid::cli
