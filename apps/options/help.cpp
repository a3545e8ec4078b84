#include "options/help.h"

#include <pellucid/names.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>

namespace pellucid::cli {
namespace {

constexpr std::size_t kNames = 32;  ///< columns

/// "FILE", without what checks add behind a colon.
std::string type_of(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    return option.get_items_expected_max() == 0 ? "" : type.substr(0, type.find(':'));
}

std::vector<std::string> names_of(const CLI::Option& option) {
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    return names;
}

std::string heading_of(const CLI::Option& option) {
    const std::string type = type_of(option);
    return fmt::format("{}{}{}", fmt::join(names_of(option), ", "), type.empty() ? "" : " ", type);
}

bool is_positional(const CLI::Option& option) { return option.get_positional(); }

std::string group_of(const CLI::App& app, const CLI::Option& option) {
    return &option == app.get_help_ptr() || &option == app.get_version_ptr() ? kGeneralGroup : option.get_group();
}

std::string text_of(const CLI::Option& option) {
    const std::string value = option.get_default_str();
    return option.get_description() + (value.empty() ? "" : fmt::format(" (default {})", value));
}

std::string row(std::string_view name, std::string_view text) { return help_row(name, text, kNames); }

std::string command_name(const CLI::App& app) {
    return app.get_parent() ? command_name(*app.get_parent()) + " " + app.get_name() : app.get_name();
}

std::string usage(const CLI::App& app) {
    std::string line = command_name(app);
    bool optional = false;
    for (const CLI::Option* option : app.get_options()) {
        const std::string name = is_positional(*option) ? type_of(*option) : heading_of(*option);
        if (option->get_required())
            line += " " + name;
        else if (is_positional(*option))
            line += fmt::format(" [{}]", name);
        else
            optional = true;
    }
    if (!commands_of(app).empty()) line += " COMMAND ...";
    return line + (optional ? " [OPTIONS]" : "");
}

/// Groups in the order in which their first options were added, the general one last.
std::vector<std::string> groups_of(const CLI::App& app) {
    std::vector<std::string> groups;
    for (const CLI::Option* option : app.get_options()) {
        const std::string group = group_of(app, *option);
        if (!is_positional(*option) && !group.empty() && group != kParameterGroup && group != kGeneralGroup &&
            std::find(groups.begin(), groups.end(), group) == groups.end())
            groups.push_back(group);
    }
    groups.push_back(kGeneralGroup);
    return groups;
}

bool has_parameters(const CLI::App& app) {
    const auto options = app.get_options();
    return std::any_of(options.begin(), options.end(), [](const auto* o) { return o->get_group() == kParameterGroup; });
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

}  // namespace

std::string wrapped(std::string_view text, std::size_t columns, std::size_t indent) {
    std::string lines;
    std::size_t width = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find_first_of(" \n"), text.size());
        const std::string_view word = text.substr(0, end);
        if (width > 0 && width + 1 + word.size() > columns) {
            lines += "\n" + std::string(indent, ' ');
            width = 0;
        }
        if (width > 0) lines += ' ', ++width;
        lines += word;
        width += word.size();
        if (end < text.size() && text[end] == '\n') {
            lines += "\n" + std::string(indent, ' ');
            width = 0;
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

std::string help_row(std::string_view name, std::string_view text, std::size_t names) {
    const std::string body = wrapped(text, kHelpColumns - names, names);
    return name.size() + 3 > names ? fmt::format("  {}\n{:{}}{}\n", name, "", names, body)
                                   : fmt::format("  {:<{}}{}\n", name, names - 2, body);
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

void use_short_help(CLI::App& app) {
    app.formatter_fn([](const CLI::App* of, const std::string&, CLI::AppFormatMode) { return make_help(*of); });
}

void set_examples(CLI::App& command, const std::vector<std::string_view>& examples) {
    command.footer(fmt::format("{}", fmt::join(examples, "\n")));
}

std::string make_help(const CLI::App& app) {
    std::string help = fmt::format("Usage: {}\n{}\n", usage(app), wrapped(app.get_description(), kHelpColumns, 0));
    const std::vector<const CLI::App*> commands = commands_of(app);
    if (!commands.empty()) help += "\nCommands (each has --help):\n";
    for (const CLI::App* command : commands) help += row(command->get_name(), command->get_description());
    std::string positionals;
    for (const CLI::Option* option : app.get_options())
        if (is_positional(*option)) positionals += row(type_of(*option), option->get_description());
    if (!positionals.empty()) help += "\n" + positionals;
    for (const std::string& group : groups_of(app)) {
        help += fmt::format("\n{}:\n", group);
        for (const CLI::Option* option : app.get_options())
            if (!is_positional(*option) && group_of(app, *option) == group)
                help += row(heading_of(*option), text_of(*option));
    }
    if (has_parameters(app))
        help += fmt::format("\n{}: --NAME VALUE, as 'pellucid techniques TECHNIQUE' lists them.\n", kParameterGroup);
    if (!app.get_footer().empty()) help += "\nExamples:\n";
    for (const std::string& example : lines_of(app.get_footer())) help += fmt::format("  {}\n", example);
    return help;
}

nlohmann::ordered_json describe_options(const CLI::App& app) {
    auto options = nlohmann::ordered_json::array();
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_group().empty()) continue;
        options.push_back({{"names", is_positional(*option) ? std::vector<std::string>{} : names_of(*option)},
                           {"value", type_of(*option)},
                           {"default", option->get_default_str()},
                           {"required", option->get_required()},
                           {"repeatable", option->get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll},
                           {"group", group_of(app, *option)},
                           {"doc", option->get_description()}});
    }
    return {{"name", app.get_name()},
            {"summary", app.get_description()},
            {"usage", usage(app)},
            {"options", std::move(options)},
            {"examples", lines_of(app.get_footer())}};
}

std::string unknown_option(const CLI::App& command, int argc, char** argv) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        std::ranges::move(names_of(*option), std::back_inserter(names));
    const std::vector<std::string_view> known(names.begin(), names.end());
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        const std::string_view name = argument.substr(0, argument.find('='));
        if (!name.starts_with("--") || name == "--" || std::ranges::find(known, name) != known.end()) continue;
        return fmt::format("unknown option '{}'{}", name, did_you_mean(name, known));
    }
    return {};
}

}  // namespace pellucid::cli
