#include "viewer/script.h"

#include "options/arguments.h"

#include <pellucid/names.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

namespace pellucid::viewer {
namespace {

struct Command {
    std::string_view name;
    std::string_view arguments;  ///< for messages
    std::size_t least, most;
};
constexpr std::array kCommands{
    Command{"open", "FILE", 1, 1},
    Command{"drop", "FILE [FILE...]", 1, 16},
    Command{"environment", "NAME|FILE", 1, 1},
    Command{"environment-rotation", "DEG", 1, 1},
    Command{"environment-intensity", "X", 1, 1},
    Command{"orbit", "AZ EL", 2, 2},
    Command{"zoom", "FACTOR", 1, 1},
    Command{"pan", "RIGHT DOWN", 2, 2},
    Command{"fly", "RIGHT UP FORWARD", 3, 3},
    Command{"frame", "", 0, 0},
    Command{"camera", "NAME", 1, 1},
    Command{"technique", "NAME", 1, 1},
    Command{"split", "NAME|off [SHARE]", 1, 2},
    Command{"set", "PARAMETER VALUE", 2, 2},
    Command{"samples", "N", 1, 1},
    Command{"view", "NAME", 1, 1},
    Command{"overlay", "NAME|off", 1, 1},
    Command{"exposure", "EV", 1, 1},
    Command{"tonemap", "NAME", 1, 1},
    Command{"light", "NAME", 1, 1},
    Command{"material", "INDEX PROPERTY VALUE [VALUE VALUE]", 3, 5},
    Command{"animation", "N|off", 1, 1},
    Command{"time", "S", 1, 1},
    Command{"play", "on|off", 1, 1},
    Command{"inspect", "X Y", 2, 2},
    Command{"cancel", "", 0, 0},
    Command{"undo", "", 0, 0},
    Command{"redo", "", 0, 0},
    Command{"panels", "on|off", 1, 1},
    Command{"help", "on|off", 1, 1},
    Command{"size", "WxH", 1, 1},
    Command{"minimize", "", 0, 0},
    Command{"restore", "", 0, 0},
    Command{"wait", "still|frames N|seconds S|file FILE", 1, 2},
    Command{"mark", "FILE", 1, 1},
    Command{"expect-message", "TEXT", 1, 1},
    Command{"expect-no-message", "", 0, 0},
    Command{"screenshot", "FILE", 1, 1},
    Command{"save", "FILE", 1, 1},
    Command{"command", "FILE", 1, 1},
    Command{"report", "FILE", 1, 1},
    Command{"close", "", 0, 0},
};

std::vector<std::string> words_of(const std::string& line) {
    std::vector<std::string> words;
    bool quoted = false, in_word = false;
    for (const char c : line) {
        if (c == '"') {
            quoted = !quoted;
            if (!in_word) words.emplace_back();
            in_word = true;
        } else if (!quoted && c == '#' && !in_word) {
            break;
        } else if (!quoted && (c == ' ' || c == '\t' || c == '\r')) {
            in_word = false;
        } else {
            if (!in_word) words.emplace_back();
            in_word = true;
            words.back() += c;
        }
    }
    if (quoted) throw Error("a quote is not closed");
    return words;
}

void check(const ScriptLine& line) {
    const auto command = std::find_if(kCommands.begin(), kCommands.end(),
                                      [&](const Command& each) { return each.name == line.command; });
    if (command == kCommands.end()) {
        std::vector<std::string_view> names;
        for (const Command& each : kCommands) names.push_back(each.name);
        throw unknown_name("command", line.command, names);
    }
    if (line.arguments.size() < command->least || line.arguments.size() > command->most)
        throw Error(fmt::format("should be: {} {}", command->name, command->arguments));
}

}  // namespace

std::vector<ScriptLine> parse_script(const std::string& text) {
    std::vector<ScriptLine> lines;
    std::istringstream stream(text);
    int number = 0;
    for (std::string row; std::getline(stream, row);) {
        ++number;
        try {
            std::vector<std::string> words = words_of(row);
            if (words.empty()) continue;
            ScriptLine line{number, words.front(), {words.begin() + 1, words.end()}};
            check(line);
            lines.push_back(std::move(line));
        } catch (const Error& error) {
            throw Error(fmt::format("line {}: {}", number, error.what()));
        }
    }
    return lines;
}

double number_at(const ScriptLine& line, std::size_t argument) {
    return cli::parse_number(fmt::format("line {}", line.number), line.arguments.at(argument));
}

}  // namespace pellucid::viewer
