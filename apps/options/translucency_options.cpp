#include "options/translucency_options.h"

#include "options/arguments.h"
#include "options/options.h"

#include "report/color_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace pellucid::cli {
namespace {

constexpr double kSunIrradiance = 3.0;  // W/m2: white that is lit head-on looks white

/// The last numbers are the intensity and the size.
struct LightKind {
    std::string_view name, parameters;
    std::size_t required, most;
};
constexpr std::array<LightKind, 3> kLightKinds = {{{"sun", "AZ,EL[,W/m2[,DEGREES]]", 2, 4},
                                                   {"lamp", "X,Y,Z,W/sr[,M]", 4, 5},
                                                   {"spot", "X,Y,Z,TO_X,TO_Y,TO_Z,DEGREES,W/sr[,M]", 8, 9}}};

glm::dvec3 vec3_at(const std::vector<double>& v, std::size_t first) { return {v[first], v[first + 1], v[first + 2]}; }

Light sun(const std::vector<double>& v) {
    const float azimuth = glm::radians(float(v[0])), elevation = glm::radians(float(v[1]));
    Light light;
    light.kind = Light::Kind::kDirectional;
    light.direction = -glm::vec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                 std::cos(elevation) * std::cos(azimuth));
    light.intensity = glm::vec3(float(v.size() > 2 ? v[2] : kSunIrradiance));
    if (v.size() > 3) light.angular_diameter = glm::radians(float(v[3]));
    return light;
}

Light spot(const std::vector<double>& v, const glm::dvec3& origin, const std::string& text) {
    Light light;
    light.kind = Light::Kind::kSpot;
    light.position = vec3_at(v, 0) - origin;
    const glm::dvec3 way = vec3_at(v, 3) - vec3_at(v, 0);
    if (!(glm::length(way) > 0.0)) throw Error(fmt::format("--add-light: '{}' shines nowhere", text));
    light.direction = glm::normalize(way);
    if (!(v[6] > 0.0 && v[6] <= 90.0))
        throw Error(fmt::format("--add-light: '{}': half the cone's angle is 0 to 90 degrees", text));
    light.outer_cone_angle = glm::radians(float(v[6]));
    light.inner_cone_angle = 0.8f * light.outer_cone_angle;
    light.intensity = glm::vec3(float(v[7]));
    if (v.size() > 8) light.radius = float(v[8]);
    return light;
}

/// `origin`: Scene::origin of the scene that the light is added to.
Light parse_light(const std::string& text, const glm::dvec3& origin) {
    const std::size_t colon = text.find(':');
    const auto kind = std::find_if(kLightKinds.begin(), kLightKinds.end(),
                                   [&](const LightKind& k) { return text.substr(0, colon) == k.name; });
    if (colon == std::string::npos || kind == kLightKinds.end())
        throw Error(fmt::format("--add-light: '{}' should be one of {}", text, fmt::join(light_forms(), ", ")));
    const std::string numbers = text.substr(colon + 1);
    const auto count = std::size_t(std::count(numbers.begin(), numbers.end(), ',')) + 1;
    const std::vector<double> v = parse_numbers("--add-light", numbers, std::clamp(count, kind->required, kind->most));
    for (std::size_t i = kind->most - 2; i < v.size(); ++i) {
        if (!(v[i] >= 0.0)) throw Error(fmt::format("--add-light: '{}': intensity and size are not negative", text));
    }
    if (kind->name == "sun" && v.size() > 3 && !(v[3] < 180.0))
        throw Error(fmt::format("--add-light: '{}': a sun's diameter is 0 to 180 degrees", text));
    if (kind->name == "sun") return sun(v);
    if (kind->name == "spot") return spot(v, origin, text);
    Light light;
    light.kind = Light::Kind::kPoint;
    light.position = vec3_at(v, 0) - origin;
    light.intensity = glm::vec3(float(v[3]));
    if (v.size() > 4) light.radius = float(v[4]);
    return light;
}

}  // namespace

std::vector<std::string> light_forms() {
    std::vector<std::string> forms;
    for (const LightKind& kind : kLightKinds) forms.push_back(fmt::format("{}:{}", kind.name, kind.parameters));
    return forms;
}

void add_translucency_options(CLI::App& command, TranslucencyArguments& arguments) {
    command
        .add_option("--translucent", arguments.translucent,
                    "Make meshes translucent: R,G,B of white light is left after M metres")
        ->type_name("R,G,B,M");
    command
        .add_option("--add-light", arguments.lights,
                    "Add sun:AZ,EL, lamp:X,Y,Z,W/sr or spot:...; may be repeated (help lights)")
        ->type_name("LIGHT")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

std::optional<Translucency> parse_translucency(const TranslucencyArguments& arguments) {
    if (!arguments.translucent) return std::nullopt;
    const std::vector<double> v = parse_numbers("--translucent", *arguments.translucent, 4);
    return Translucency{vec3_at(v, 0), float(v[3])};
}

std::vector<Light> parse_lights(const TranslucencyArguments& arguments, const glm::dvec3& origin) {
    std::vector<Light> lights;
    for (const std::string& text : arguments.lights) {
        lights.push_back(parse_light(text, origin));
        lights.back().name = text;
    }
    return lights;
}

void add_thickness_options(CLI::App& command, ThicknessArguments& arguments, bool short_names) {
    command.option_defaults()->group("Thickness");
    command
        .add_option(short_names ? "--thickness-method,--method" : "--thickness-method", arguments.method,
                    "How the length of solid before a point is found (help translucency)")
        ->capture_default_str()
        ->type_name("NAME");
    add_light_map_options(command, arguments, short_names);
}

void add_light_map_options(CLI::App& command, ThicknessArguments& arguments, bool short_names) {
    command.option_defaults()->group("Thickness");
    add_number(command, short_names ? "--thickness-layers,--layers" : "--thickness-layers", arguments.layers,
               "Surfaces that are kept of every ray of light")
        ->capture_default_str();
    add_number(command, "--light-map", arguments.resolution, "Texels along a side of a light's map")
        ->capture_default_str();
}

ThicknessSettings thickness_settings(const ThicknessArguments& arguments) {
    return {parse_thickness_method(arguments.method), arguments.layers, arguments.resolution};
}

std::vector<NamedCamera> cameras_about_light(const Scene& scene, const Light& light, std::uint32_t width,
                                             std::uint32_t height) {
    const Bounds bounds = scene_bounds(scene);
    glm::vec3 way = light.direction;
    if (light.kind != Light::Kind::kDirectional && glm::distance(bounds.center, light.position) > 0.0f)
        way = glm::normalize(bounds.center - light.position);
    const float azimuth = std::atan2(way.x, way.z) * (180.0f / std::numbers::pi_v<float>);
    const float fov = Camera{}.vertical_fov;
    const float share = 0.95f * std::min(1.0f, float(width) / float(height));
    const float distance = framing_distance(fov, share);
    const auto at = [&](float azimuth_deg, float elevation_deg) {
        return orbit_camera(bounds, azimuth_deg, elevation_deg, distance, fov);
    };
    return {{"behind", at(azimuth, 10.0f)}, {"side", at(azimuth + 90.0f, 0.0f)}, {"top", at(azimuth + 90.0f, 89.9f)}};
}

Image color_thickness(const Image& thickness, float full) {
    const ColorScale scale;
    Image picture(thickness.width, thickness.height, 3);
    for (std::size_t i = 0; i < thickness.pixels.size(); ++i) {
        const float d = thickness.pixels[i];
        const glm::vec3 color = d == kShadowed ? 0.5f * kUncoveredColor
                                : d < 0.0f     ? kUncoveredColor
                                               : scale.at(full > 0.0f ? d / full : 0.0f);
        std::copy_n(&color.x, 3, picture.pixels.data() + 3 * i);
    }
    return picture;
}

float largest_value(const Image& thickness) {
    float largest = 0.0f;
    for (const float d : thickness.pixels) largest = std::max(largest, d);
    return largest;
}

}  // namespace pellucid::cli
