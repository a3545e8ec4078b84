#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::viewer {

/// One line of a script: a command and its arguments. docs/viewer.md lists the commands.
struct ScriptLine {
    int number = 0;  ///< from 1
    std::string command;
    std::vector<std::string> arguments;
};

/// The lines of a script. Words are separated by blanks; double quotes keep blanks inside of a word; `#` starts a comment.
/// Throws Error naming the line for unknown commands, a wrong number of arguments and quotes that are not closed.
std::vector<ScriptLine> parse_script(const std::string& text);

/// The arguments of a line that are numbers. Throws Error naming the line.
double number_at(const ScriptLine& line, std::size_t argument);

}  // namespace pellucid::viewer
