#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid::cli {

/// Group of options that --help leaves to 'pellucid techniques'.
inline constexpr const char* kParameterGroup = "Parameters of techniques";

/// Group of options that most commands have, the last of --help.
inline constexpr const char* kGeneralGroup = "General";

/// Columns that a line of help has at most.
inline constexpr std::size_t kHelpColumns = 100;

/// --help of `app`, and of the commands that are added to it afterwards, as make_help() has it.
void use_short_help(CLI::App& app);
/// Command lines that --help ends with.
void set_examples(CLI::App& command, const std::vector<std::string_view>& examples);

/// Usage, options by group in the order in which they were added, and examples; lines have 100 columns at most.
std::string make_help(const CLI::App& app);

/// The table that help is made of, for man pages and completion: summary, usage, options and examples.
nlohmann::ordered_json describe_options(const CLI::App& app);

/// `text` in lines of `columns` at most, those after the first indented. Line feeds in it stay.
std::string wrapped(std::string_view text, std::size_t columns, std::size_t indent);

/// A row of a table, "  NAME    TEXT\n", whose text begins at column `names` and is wrapped. A name that is too long has a
/// line of its own.
std::string help_row(std::string_view name, std::string_view text, std::size_t names);

std::vector<const CLI::App*> commands_of(const CLI::App& app);

/// "unknown option '--colour' (did you mean ...?)" of the first argument that is no option of `command`; empty if all are
/// known.
std::string unknown_option(const CLI::App& command, int argc, char** argv);

}  // namespace pellucid::cli
