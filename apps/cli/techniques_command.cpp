#include "commands.h"
#include "options/help.h"

#include <pellucid/names.h>
#include <pellucid/pellucid.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pellucid::cli {
namespace {

constexpr std::size_t kNameWidth = 26;  ///< columns

struct TechniquesArguments {
    std::string name;
    bool json = false;
};

std::string row(std::string_view name, std::string_view text) { return help_row(name, text, kNameWidth); }

/// ", section 3" of "3", ", sections 2 and 4" of "2 and 4", ", chapter 3" of "chapter 3".
std::string place_in(std::string_view section) {
    constexpr std::string_view kDigits = "0123456789.";
    if (section.empty()) return {};
    if (kDigits.find(section.front()) == std::string_view::npos) return fmt::format(", {}", section);
    const bool one = section.find_first_not_of(kDigits) == std::string_view::npos;
    return fmt::format(", section{} {}", one ? "" : "s", section);
}

std::string citation(const Source& source) {
    if (source.authors.empty()) return {};
    return fmt::format("{}: {}. {}, {}{}", source.authors, source.title, source.venue, source.year,
                       place_in(source.section));
}

/// What sets a technique apart, in words, by TechniqueInfo's flags.
std::vector<std::string_view> traits(const TechniqueInfo& info) {
    const std::array<std::pair<bool, std::string_view>, 9> all = {{
        {info.reference, "a truth: traced on the CPU, for others to be measured against"},
        {info.all_light, "all light: reflections inside, lamps, caustics; --samples are paths per pixel"},
        {info.whole_scene, "refracted rays meet everything: opaque objects, thin walls, rough and dispersive glass"},
        {info.opaque_behind && !info.whole_scene, "opaque objects are seen through glass"},
        {!info.opaque_behind && !info.whole_scene && !info.all_light, "only the environment is seen through glass"},
        {info.many_media, "each solid has its own medium"},
        {info.volumes, "volumes of varying index are drawn"},
        {info.lit_glass, "lights of the scene light its glass"},
        {info.bakes, "meshes are prepared once, which takes time"},
    }};
    std::vector<std::string_view> words;
    for (const auto& [holds, text] : all)
        if (holds) words.push_back(text);
    return words;
}

std::string value_text(const ParameterInfo& parameter, double value) {
    for (const NamedValue& named : parameter.names)
        if (named.value == value) return std::string(named.name);
    return fmt::format("{}", value);
}

std::string parameter_text(const ParameterInfo& parameter) {
    std::string text =
        fmt::format("{}{}{} ({} to {}, default {})", parameter.doc, parameter.unit.empty() ? "" : ", ", parameter.unit,
                    parameter.minimum, parameter.maximum, value_text(parameter, parameter.default_value));
    for (const NamedValue& named : parameter.names)
        text += fmt::format("\n{} = {}{}{}", named.value, named.name, named.doc.empty() ? "" : ": ", named.doc);
    return text;
}

void print_list() {
    fmt::print("Techniques, for --technique; 'pellucid techniques NAME' lists parameters:\n\n");
    for (const TechniqueInfo* info : techniques()) {
        const std::string source = citation(info->source);
        fmt::print("{}", row(info->name, fmt::format("{}{}{}", info->summary, source.empty() ? "" : "\n", source)));
    }
    fmt::print("\nPresets, which stand for the fastest technique of their kind on the device:\n\n");
    for (const PresetInfo& preset : presets()) fmt::print("{}", row(preset.name, preset.summary));
}

void print_technique(const TechniqueInfo& info) {
    fmt::print("{}: {}\n", info.name, wrapped(info.summary, kHelpColumns - info.name.size() - 2, 4));
    if (const std::string source = citation(info.source); !source.empty())
        fmt::print("Source: {}\n", wrapped(source, kHelpColumns - 8, 4));
    fmt::print("\nDraws:\n");
    for (const std::string_view trait : traits(info)) fmt::print("  {}\n", trait);
    fmt::print("\nParameters:{}\n", info.parameters.empty() ? " none" : "");
    for (const ParameterInfo& parameter : info.parameters)
        fmt::print("{}", row(fmt::format("--{} {}", parameter.name, parameter.names.empty() ? "X" : "NAME|N"),
                             parameter_text(parameter)));
}

nlohmann::ordered_json as_json(const ParameterInfo& parameter) {
    nlohmann::ordered_json json{{"name", parameter.name},
                                {"unit", parameter.unit},
                                {"default", parameter.default_value},
                                {"minimum", parameter.minimum},
                                {"maximum", parameter.maximum},
                                {"whole", parameter.whole},
                                {"doc", parameter.doc},
                                {"names", nlohmann::ordered_json::array()}};
    for (const NamedValue& named : parameter.names)
        json["names"].push_back({{"value", named.value}, {"name", named.name}, {"doc", named.doc}});
    return json;
}

nlohmann::ordered_json as_json(const TechniqueInfo& info) {
    nlohmann::ordered_json json{{"name", info.name}, {"summary", info.summary}, {"source", nullptr}};
    if (!info.source.authors.empty())
        json["source"] = {{"authors", info.source.authors},
                          {"title", info.source.title},
                          {"venue", info.source.venue},
                          {"year", info.source.year},
                          {"section", info.source.section}};
    json.update({{"reference", info.reference},
                 {"all_light", info.all_light},
                 {"many_media", info.many_media},
                 {"bakes", info.bakes},
                 {"opaque_behind", info.opaque_behind},
                 {"whole_scene", info.whole_scene},
                 {"volumes", info.volumes},
                 {"lit_glass", info.lit_glass},
                 {"recordable", info.recordable},
                 {"parameters", nlohmann::ordered_json::array()}});
    for (const ParameterInfo& parameter : info.parameters) json["parameters"].push_back(as_json(parameter));
    return json;
}

void print_json(const std::string& name) {
    nlohmann::ordered_json json{{"version", version()},
                                {"techniques", nlohmann::ordered_json::array()},
                                {"presets", nlohmann::ordered_json::array()}};
    for (const TechniqueInfo* info : techniques())
        if (name.empty() || info->name == name) json["techniques"].push_back(as_json(*info));
    for (const PresetInfo& preset : presets())
        if (name.empty() || preset.name == name)
            json["presets"].push_back({{"name", preset.name}, {"summary", preset.summary}});
    fmt::print("{}\n", json.dump(2));
}

void show(const TechniquesArguments& arguments) {
    if (!arguments.name.empty()) check_technique_name(arguments.name);
    if (arguments.json) return print_json(arguments.name);
    if (arguments.name.empty()) return print_list();
    for (const PresetInfo& preset : presets())
        if (preset.name == arguments.name)
            return fmt::print("{}: a preset: {}\n", preset.name, wrapped(preset.summary, kHelpColumns - 20, 4));
    print_technique(find_technique(arguments.name));
}

}  // namespace

void add_techniques_command(CLI::App& app) {
    auto arguments = std::make_shared<TechniquesArguments>();
    CLI::App* command = app.add_subcommand(
        "techniques", "List techniques with their sources, or one with what it draws and its parameters");
    command->add_option("name", arguments->name, "A technique or a preset")->type_name("NAME");
    command->option_defaults()->group(kGeneralGroup);
    command->add_flag("--json", arguments->json, "Print JSON");
    set_examples(*command, {"pellucid techniques", "pellucid techniques wang-2014"});
    command->callback([arguments] { show(*arguments); });
}

}  // namespace pellucid::cli
