#include "options/console.h"

#include "options/help.h"

namespace pellucid::cli {

void Console::warn(const std::vector<std::string>& warnings) const {
    if (quiet) return;
    for (const std::string& warning : warnings)
        std::fputs(fmt::format("pellucid: warning: {}\n", warning).c_str(), stderr);
}

void Console::report(const std::string& text) const {
    if (verbose) std::fputs(fmt::format("pellucid: {}\n", text).c_str(), stderr);
}

void add_console_options(CLI::App& command, Console& console) {
    command.option_defaults()->group(kGeneralGroup);
    CLI::Option* const quiet =
        command.add_flag("--quiet", console.quiet, "Print errors only: no warnings, progress or tables");
    command.add_flag("--verbose", console.verbose, "Report each step with its time, on stderr")->excludes(quiet);
}

}  // namespace pellucid::cli
