#pragma once

// Options about translucent solids and the lights that shine through them.

#include <pellucid/pellucid.h>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::cli {

/// What the command line adds to a scene. Strings are parsed when the command runs, so that errors are ours.
struct TranslucencyArguments {
    std::optional<std::string> translucent;
    std::vector<std::string> lights;
};
/// "sun:AZ,EL[,W/m2[,DEGREES]]", one for each kind of --add-light.
std::vector<std::string> light_forms();
void add_translucency_options(CLI::App& command, TranslucencyArguments& arguments);
std::optional<Translucency> parse_translucency(const TranslucencyArguments& arguments);
/// Positions are given in the file's world; `origin` is Scene::origin of the scene that the lights are for.
/// Throws Error naming what is wrong with one of them.
std::vector<Light> parse_lights(const TranslucencyArguments& arguments, const glm::dvec3& origin);

/// How thickness is found. `short_names`: --method and --layers do as well.
struct ThicknessArguments {
    std::string method = "layers";
    std::uint32_t layers = ThicknessSettings{}.layers;
    std::uint32_t resolution = ThicknessSettings{}.resolution;
};
void add_thickness_options(CLI::App& command, ThicknessArguments& arguments, bool short_names = false);
/// The same without the method.
void add_light_map_options(CLI::App& command, ThicknessArguments& arguments, bool short_names = false);
ThicknessSettings thickness_settings(const ThicknessArguments& arguments);

/// Cameras that look at a scene as light goes through it.
struct NamedCamera {
    std::string name;  ///< behind: towards the light; side; top
    Camera camera;
};
std::vector<NamedCamera> cameras_about_light(const Scene& scene, const Light& light, std::uint32_t width,
                                             std::uint32_t height);

/// Pictures of a thickness or of an error from 0 to `full` metres, for display: dark blue to pale yellow, dark grey
/// where there is none, darker in an opaque object's shadow.
Image color_thickness(const Image& thickness, float full);
float largest_value(const Image& thickness);

}  // namespace pellucid::cli
