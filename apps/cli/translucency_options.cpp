#include "translucency_options.h"

#include "arguments.h"
#include "options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid::cli {
namespace {

/// Under which a white surface that faces the light is as bright as one in an environment of radiance 1.
constexpr double kDefaultIrradiance = std::numbers::pi;

std::string method_list() {
    std::string help;
    for (const ThicknessMethodInfo& info : thickness_methods())
        help += fmt::format(" {} ({});", info.name, info.summary);
    help.pop_back();
    return help;
}

/// From where an orbit camera of that azimuth and elevation would look.
Light parse_light(const std::string& text, const Scene& scene) {
    const std::size_t count = std::size_t(std::count(text.begin(), text.end(), ',')) + 1;
    const std::vector<double> numbers = parse_numbers("--light", text, count == 3 ? 3 : 2);
    if (!(std::abs(numbers[1]) <= 90.0))
        throw Error(fmt::format("--light: elevation {} is not -90 to 90 degrees", numbers[1]));
    const double irradiance = count == 3 ? numbers[2] : kDefaultIrradiance;
    if (!(irradiance >= 0.0)) throw Error(fmt::format("--light: irradiance {} is below 0", irradiance));
    const Bounds bounds = scene_bounds(scene);
    const Camera there = orbit_camera(bounds, float(numbers[0]), float(numbers[1]), 2.0f, Camera{}.vertical_fov);
    Light light;
    light.name = fmt::format("--light {}", text);
    light.kind = Light::Kind::kDirectional;
    light.direction = -glm::normalize(glm::vec3(there.world_from_view[2]));
    light.intensity = glm::vec3(float(irradiance));
    return light;
}

}  // namespace

void add_translucency_options(CLI::App& command, TranslucencyArguments& arguments) {
    const std::string group = "Light through solids";
    command
        .add_option("--translucent", arguments.translucent,
                    "Makes every material of the scene wax, jade or skin: of white light R,G,B is left after M metres")
        ->type_name("R,G,B,M")
        ->group(group);
    command
        .add_option(
            "--light", arguments.lights,
            "Adds a directional light from an azimuth and elevation, degrees as of --camera orbit, of irradiance "
            "E, W/m2 (default pi); may be repeated")
        ->type_name("AZ,EL[,E]")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->group(group);
    command
        .add_option("--thickness-method", arguments.method,
                    "How the length of solid before a point is found:" + method_list())
        ->capture_default_str()
        ->type_name("METHOD")
        ->group(group);
    add_number(command, "--thickness-layers", arguments.layers, "Surfaces kept of every ray of light")
        ->capture_default_str()
        ->group(group);
    add_number(command, "--light-map", arguments.resolution, "Texels along a side of a light's map")
        ->capture_default_str()
        ->group(group);
}

std::optional<Translucency> parse_translucency(const TranslucencyArguments& arguments) {
    if (!arguments.translucent) return std::nullopt;
    const auto n = parse_numbers("--translucent", *arguments.translucent, 4);
    return Translucency{glm::vec3(float(n[0]), float(n[1]), float(n[2])), float(n[3])};
}

void add_lights(Scene& scene, const TranslucencyArguments& arguments) {
    for (const std::string& text : arguments.lights) scene.lights.push_back(parse_light(text, scene));
}

ThicknessSettings thickness_settings(const TranslucencyArguments& arguments) {
    return {parse_thickness_method(arguments.method), arguments.layers, arguments.resolution};
}

}  // namespace pellucid::cli
