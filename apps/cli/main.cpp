#include "cli/command_line.h"
#include "cli/commands.h"
#include "options/arguments.h"
#include "options/interrupts.h"

#include <pellucid/error.h>

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

/// The command as it can be typed again.
std::string command_line(int argc, char** argv) {
    std::string line = "pellucid";
    for (int i = 1; i < argc; ++i) line += " " + pellucid::cli::shell_quoted(argv[i]);
    return line;
}

}  // namespace

int main(int argc, char** argv) {
    const pellucid::cli::Interrupts interrupts;
    CLI::App app{
        "Pellucid renders glass in real time. Exit codes: 0 done, 2 bad input or usage, 3 no suitable device, 4 frames "
        "of a sequence are missing, "
        "1 a bug.",
        "pellucid"};
    pellucid::cli::add_commands(app, command_line(argc, argv));
    try {
        pellucid::cli::parse_arguments(app, argc, argv);
        return kDone;
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        return complain(pellucid::cli::usage_error(app, error, argc, argv), kBadInput);
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
