#include "cli/command_line.h"

#include "cli/commands.h"
#include "lab/commands.h"
#include "options/arguments.h"
#include "options/help.h"

#include <pellucid/error.h>
#include <pellucid/names.h>
#include <pellucid/pellucid.h>

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

namespace pellucid::cli {
namespace {

/// The parser would only say that a command is missing.
void check_command(const CLI::App& app, const std::string& command) {
    std::vector<std::string> names;
    for (const CLI::App* subcommand : commands_of(app)) {
        if (subcommand->get_name() == command) return;
        names.push_back(subcommand->get_name());
    }
    throw unknown_name("command", command, std::vector<std::string_view>(names.begin(), names.end()));
}

}  // namespace

void add_commands(CLI::App& app, const std::string& command_line) {
    app.set_version_flag("--version", std::string(version()));
    app.require_subcommand(1);
    use_short_help(app);
    set_examples(app, {"pellucid render shape:goblet -o goblet.png", "pellucid techniques",
                       "pellucid help lights    # 'pellucid help' lists the topics"});
    add_render_command(app);
    add_sequence_command(app);
    add_compare_command(app, command_line);
    add_bench_command(app);
    add_experiment_command(app);
    add_difference_command(app);
    add_dataset_command(app);
    add_thickness_command(app);
    add_volume_command(app);
    add_export_command(app);
    add_info_command(app);
    add_techniques_command(app);
    add_help_command(app);
}

void parse_arguments(CLI::App& app, int argc, char** argv) {
    if (argc == 1) throw Error("no command given (see 'pellucid --help')");
    if (argv[1][0] != '-') check_command(app, argv[1]);
    app.parse(argc, argv);
}

std::string usage_error(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
    const std::vector<const CLI::App*> parsed =
        app.get_subcommands([&](const CLI::App* command) { return argc > 1 && command->get_name() == argv[1]; });
    const CLI::App& command = parsed.empty() ? app : *parsed.front();
    const std::string unknown = unknown_option(command, argc, argv);
    return fmt::format("{} (see 'pellucid{} --help')", unknown.empty() ? error.what() : unknown,
                       parsed.empty() ? "" : " " + command.get_name());
}

}  // namespace pellucid::cli
