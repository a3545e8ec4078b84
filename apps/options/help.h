#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace pellucid::cli {

/// Group of options that --help leaves to 'pellucid techniques'.
inline constexpr const char* kParameterGroup = "Parameters of techniques";

/// Group of options that most commands have, the last of --help.
inline constexpr const char* kGeneralGroup = "General";

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

/// "unknown option '--colour' (did you mean ...?)" of the first argument that is no option of `command`; empty if all are
/// known.
std::string unknown_option(const CLI::App& command, int argc, char** argv);

}  // namespace pellucid::cli
