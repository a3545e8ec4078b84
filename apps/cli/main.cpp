#include "commands.h"
#include "lab/commands.h"
#include "options/arguments.h"
#include "options/help.h"

#include <pellucid/error.h>
#include <pellucid/names.h>
#include <pellucid/pellucid.h>

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

namespace {

constexpr int kDone = 0;
constexpr int kBug = 1;
constexpr int kBadInput = 2;
constexpr int kNoDevice = 3;
constexpr int kFramesMissing = 4;

int complain(const std::string& message, int exit_code) {
    // fputs does not throw where stderr is closed: the exit code is still to be given.
    std::fputs(fmt::format("pellucid: {}\n", pellucid::one_line(message)).c_str(), stderr);
    return exit_code;
}

/// The parser would only say that a command is missing.
void check_command(const CLI::App& app, const std::string& command) {
    std::vector<std::string> names;
    for (const CLI::App* subcommand : pellucid::cli::commands_of(app)) {
        if (subcommand->get_name() == command) return;
        names.push_back(subcommand->get_name());
    }
    throw pellucid::unknown_name("command", command, std::vector<std::string_view>(names.begin(), names.end()));
}

/// An error of the parser in one line, with the option that may have been meant, and where to read on.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
    const std::vector<const CLI::App*> parsed =
        app.get_subcommands([&](const CLI::App* command) { return argc > 1 && command->get_name() == argv[1]; });
    const CLI::App& command = parsed.empty() ? app : *parsed.front();
    const std::string unknown = pellucid::cli::unknown_option(command, argc, argv);
    return fmt::format("{} (see 'pellucid{} --help')", unknown.empty() ? error.what() : unknown,
                       parsed.empty() ? "" : " " + command.get_name());
}

/// The command as it can be typed again.
std::string command_line(int argc, char** argv) {
    std::string line = "pellucid";
    for (int i = 1; i < argc; ++i) line += " " + pellucid::cli::shell_quoted(argv[i]);
    return line;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{
        "Pellucid renders glass in real time. Exit codes: 0 done, 2 bad input or usage, 3 no suitable device, 4 frames "
        "of a sequence are missing, "
        "1 a bug.",
        "pellucid"};
    app.set_version_flag("--version", std::string(pellucid::version()));
    app.require_subcommand(1);
    pellucid::cli::use_short_help(app);
    pellucid::cli::set_examples(app, {"pellucid render shape:goblet -o goblet.png", "pellucid techniques",
                                      "pellucid help lights    # 'pellucid help' lists the topics"});
    pellucid::cli::add_render_command(app);
    pellucid::cli::add_sequence_command(app);
    pellucid::cli::add_compare_command(app, command_line(argc, argv));
    pellucid::cli::add_bench_command(app);
    pellucid::cli::add_experiment_command(app);
    pellucid::cli::add_difference_command(app);
    pellucid::cli::add_dataset_command(app);
    pellucid::cli::add_thickness_command(app);
    pellucid::cli::add_volume_command(app);
    pellucid::cli::add_export_command(app);
    pellucid::cli::add_info_command(app);
    pellucid::cli::add_techniques_command(app);
    pellucid::cli::add_help_command(app);
    try {
        if (argc == 1) throw pellucid::Error("no command given (see 'pellucid --help')");
        if (argv[1][0] != '-') check_command(app, argv[1]);
        app.parse(argc, argv);
        return kDone;
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        return complain(usage_error(app, error, argc, argv), kBadInput);
    } catch (const pellucid::Error& error) {
        return complain(error.what(), kBadInput);
    } catch (const pellucid::DeviceError& error) {
        return complain(error.what(), kNoDevice);
    } catch (const pellucid::cli::FramesMissing& error) {
        return complain(error.what(), kFramesMissing);
    } catch (const std::bad_alloc&) {
        return complain("out of memory", kBadInput);
    } catch (const std::exception& error) {
        return complain(fmt::format("internal error: {}", error.what()), kBug);
    }
}
