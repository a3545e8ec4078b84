#include "options/named_technique.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>

namespace pellucid::cli {

void add_techniques_option(CLI::App& command, std::string& techniques) {
    command
        .add_option("--techniques", techniques,
                    "Names with commas (pellucid techniques); default: all that the device offers but truths")
        ->type_name("A,B,..");
}

bool has_parameter(const TechniqueInfo& technique, std::string_view name) {
    return std::any_of(technique.parameters.begin(), technique.parameters.end(),
                       [&](const ParameterInfo& parameter) { return parameter.name == name; });
}

std::vector<NamedTechnique> parse_techniques(const std::string& names, const Renderer& renderer) {
    std::vector<NamedTechnique> chosen;
    if (names.empty()) {
        for (const TechniqueInfo* technique : techniques()) {
            if (!technique->reference && renderer.lacking(*technique).empty())
                chosen.push_back({std::string(technique->name), {technique, {}}});
        }
        return chosen;
    }
    std::istringstream stream(names);
    for (std::string name; std::getline(stream, name, ',');) {
        NamedTechnique technique{name, renderer.choose(name)};
        if (const std::string lacking = renderer.lacking(technique.info()); !lacking.empty())
            throw DeviceError(fmt::format("{} needs {}, which {} lacks", name, lacking, renderer.device().name));
        const bool again =
            std::any_of(chosen.begin(), chosen.end(), [&](const NamedTechnique& other) { return other.name == name; });
        if (!again) chosen.push_back(std::move(technique));
    }
    return chosen;
}

ParameterMap parameters_of(const NamedTechnique& technique, const ParameterMap& given) {
    ParameterMap own = technique.choice.parameters;
    for (const auto& [name, value] : given) {
        if (has_parameter(technique.info(), name)) own[name] = value;
    }
    return own;
}

void check_parameters(const std::vector<NamedTechnique>& techniques, const ParameterMap& given) {
    for (const auto& [name, value] : given) {
        const bool known = std::any_of(
            techniques.begin(), techniques.end(),
            [&, wanted = std::string_view(name)](const NamedTechnique& t) { return has_parameter(t.info(), wanted); });
        if (!known) throw Error(fmt::format("--{}: none of the techniques has this parameter", name));
    }
}

void add_technique(nlohmann::ordered_json& run, const NamedTechnique& technique) {
    run["technique"] = technique.name;
    if (technique.name != technique.info().name) run["stands_for"] = technique.info().name;
    if (!technique.choice.reason.empty()) run["because"] = technique.choice.reason;
}

void add_parameters(nlohmann::ordered_json& run, const TechniqueInfo& technique, const ParameterMap& given) {
    run["parameters"] = describe_parameters(technique, given);
    for (const ParameterInfo& parameter : technique.parameters) {
        const std::string name(parameter.name);
        for (const NamedValue& value : parameter.names)
            if (value.value == run["parameters"][name].get<double>()) run["parameter_names"][name] = value.name;
    }
}

nlohmann::ordered_json describe_parameters(const TechniqueInfo& technique, const ParameterMap& given) {
    auto json = nlohmann::ordered_json::object();
    for (const ParameterInfo& parameter : technique.parameters) {
        const auto found = given.find(parameter.name);
        json[std::string(parameter.name)] = found == given.end() ? parameter.default_value : found->second;
    }
    return json;
}

}  // namespace pellucid::cli
