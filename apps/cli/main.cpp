#include "commands.h"

#include <pellucid/pellucid.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>

namespace {

constexpr int kDone = 0;
constexpr int kBug = 1;
constexpr int kBadInput = 2;
constexpr int kNoDevice = 3;

int complain(std::string message, int exit_code) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    fmt::print(stderr, "pellucid: {}\n", message);
    return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Pellucid renders glass in real time.", "pellucid"};
    app.set_version_flag("--version", std::string(pellucid::version()));
    app.require_subcommand(1);
    app.footer("Exit codes: 0 done, 2 bad input or usage, 3 no suitable device, 1 a bug.");
    pellucid::cli::add_render_command(app);
    pellucid::cli::add_info_command(app);
    try {
        app.parse(argc, argv);
        return kDone;
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        return complain(fmt::format("{} (see 'pellucid --help')", error.what()), kBadInput);
    } catch (const pellucid::Error& error) {
        return complain(error.what(), kBadInput);
    } catch (const pellucid::DeviceError& error) {
        return complain(error.what(), kNoDevice);
    } catch (const std::bad_alloc&) {
        return complain("out of memory", kBadInput);
    } catch (const std::exception& error) {
        return complain(fmt::format("internal error: {}", error.what()), kBug);
    }
}
