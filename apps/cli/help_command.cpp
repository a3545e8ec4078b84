#include "commands.h"
#include "options/help.h"
#include "topics.h"

#include <pellucid/names.h>
#include <pellucid/pellucid.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace pellucid::cli {
namespace {

constexpr std::size_t kTopicWidth = 16;  ///< columns

struct HelpArguments {
    std::string topic;
    bool json = false;
};

/// Rows have been wrapped before.
void print_wrapped(const std::string& text) {
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        fmt::print("{}\n", line.size() <= kHelpColumns ? line : wrapped(line, kHelpColumns, 0));
}

void print_topics(const CLI::App& app) {
    fmt::print("pellucid help COMMAND or pellucid help TOPIC\n\nCommands:\n");
    for (const CLI::App* command : commands_of(app))
        fmt::print("{}", help_row(command->get_name(), command->get_description(), kTopicWidth));
    fmt::print("\nTopics:\n");
    for (const Topic& topic : topics()) fmt::print("{}", help_row(topic.name, topic.summary, kTopicWidth));
}

/// All that --help and this command can print.
void print_json(const CLI::App& app) {
    nlohmann::ordered_json json{{"version", version()}, {"program", describe_options(app)}};
    for (const CLI::App* command : commands_of(app)) json["commands"].push_back(describe_options(*command));
    for (const Topic& topic : topics())
        json["topics"].push_back({{"name", topic.name}, {"summary", topic.summary}, {"text", topic.text()}});
    fmt::print("{}\n", json.dump(2));
}

void print_help(const CLI::App& app, const HelpArguments& arguments) {
    if (arguments.json) return print_json(app);
    if (arguments.topic.empty()) return print_topics(app);
    std::vector<std::string> names;
    for (const CLI::App* command : commands_of(app)) {
        if (command->get_name() == arguments.topic) return fmt::print("{}", make_help(*command));
        names.push_back(command->get_name());
    }
    for (const Topic& topic : topics()) {
        if (topic.name == arguments.topic) return print_wrapped(topic.text());
        names.emplace_back(topic.name);
    }
    throw unknown_name("topic", arguments.topic, std::vector<std::string_view>(names.begin(), names.end()));
}

}  // namespace

void add_help_command(CLI::App& app) {
    auto arguments = std::make_shared<HelpArguments>();
    CLI::App* command = app.add_subcommand("help", "Explain a command or a topic, or list both");
    command->add_option("topic", arguments->topic, "A command or a topic")->type_name("NAME");
    command->option_defaults()->group(kGeneralGroup);
    command->add_flag("--json", arguments->json, "Print all commands, options and topics as JSON");
    set_examples(*command, {"pellucid help render", "pellucid help lights"});
    command->callback([arguments, &app] { print_help(app, *arguments); });
}

}  // namespace pellucid::cli
