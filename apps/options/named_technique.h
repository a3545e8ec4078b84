#pragma once

#include <pellucid/pellucid.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace pellucid::cli {

/// A technique, or a preset and what it stands for, under the name by which it was asked for.
struct NamedTechnique {
    std::string name;
    TechniqueChoice choice;

    const TechniqueInfo& info() const { return *choice.technique; }
};

/// "A,B,.." as techniques; empty: every one that the device offers and that is no reference, and no presets.
/// Throws Error listing the known names, DeviceError for one that the device does not offer.
std::vector<NamedTechnique> parse_techniques(const std::string& names, const Renderer& renderer);

/// The preset's parameters, and those of `given` that the technique has, which go first.
ParameterMap parameters_of(const NamedTechnique& technique, const ParameterMap& given);
/// --techniques, of names with commas.
void add_techniques_option(CLI::App& command, std::string& techniques);

bool has_parameter(const TechniqueInfo& technique, std::string_view name);
/// Throws Error if one of `given` belongs to none of `techniques`.
void check_parameters(const std::vector<NamedTechnique>& techniques, const ParameterMap& given);

/// Adds the name, and of a preset what it stands for.
void add_technique(nlohmann::ordered_json& run, const NamedTechnique& technique);

/// Adds "parameters": every parameter of the technique with its value; and "parameter_names" of those whose value has one.
void add_parameters(nlohmann::ordered_json& run, const TechniqueInfo& technique, const ParameterMap& given);
/// Every parameter of the technique with its value.
nlohmann::ordered_json describe_parameters(const TechniqueInfo& technique, const ParameterMap& given);

}  // namespace pellucid::cli
