#pragma once

#include <pellucid/pellucid.h>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::cli {

/// What commands ask for that let light through solids.
struct TranslucencyArguments {
    std::optional<std::string> translucent;  ///< "R,G,B,M"
    std::vector<std::string> lights;         ///< "AZ,EL" or "AZ,EL,E" each
    std::string method = "layers";
    std::uint32_t layers = ThicknessSettings{}.layers;
    std::uint32_t resolution = ThicknessSettings{}.resolution;
};
void add_translucency_options(CLI::App& command, TranslucencyArguments& arguments);

/// Of load_scene(): what --translucent says.
std::optional<Translucency> parse_translucency(const TranslucencyArguments& arguments);
/// Adds the lights of --light to the scene.
void add_lights(Scene& scene, const TranslucencyArguments& arguments);
ThicknessSettings thickness_settings(const TranslucencyArguments& arguments);

}  // namespace pellucid::cli
