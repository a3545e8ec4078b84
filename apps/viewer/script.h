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

/// Parses a script into lines. Blanks separate words; double quotes enclose words with blanks; `#` starts a comment.
/// Throws Error naming the line for unknown commands, wrong numbers of arguments and unclosed quotes.
std::vector<ScriptLine> parse_script(const std::string& text);

/// A numeric argument of a line. Throws Error naming the line.
double number_at(const ScriptLine& line, std::size_t argument);

}  // namespace pellucid::viewer
