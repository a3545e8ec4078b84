#include <pellucid/environment.h>
#include <pellucid/error.h>
#include <pellucid/file.h>
#include <pellucid/names.h>

#include <fmt/format.h>

#include "core/fail.h"
#include "core/math.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

namespace pellucid {
namespace {

namespace formulas {
using glm::abs, glm::acos, glm::atan, glm::clamp, glm::dot, glm::exp, glm::floor, glm::length, glm::max, glm::min,
    glm::mix, glm::pow, glm::smoothstep;
using glm::vec2, glm::vec3, glm::uint;
#include "scene/environment_formulas.glsl"

static_assert(kEnvironmentMap == uint(Environment::Kind::kMap) &&
              kEnvironmentStudio == uint(Environment::Kind::kStudio) &&
              kEnvironmentChecker == uint(Environment::Kind::kChecker) &&
              kEnvironmentSky == uint(Environment::Kind::kSky) &&
              kEnvironmentUniform == uint(Environment::Kind::kUniform));
}  // namespace formulas

constexpr std::pair<std::string_view, Environment::Kind> kNames[] = {
    {"studio", Environment::Kind::kStudio},
    {"checker", Environment::Kind::kChecker},
    {"sky", Environment::Kind::kSky},
    {"uniform", Environment::Kind::kUniform},
};

/// Three channels from grey (repeated), grey and alpha, or colour and alpha (alpha dropped).
Image to_rgb(const Image& image) {
    Image rgb(image.width, image.height, 3);
    const bool grey = image.channels < 3;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int channel = 0; channel < 3; ++channel) rgb.at(x, y)[channel] = image.at(x, y)[grey ? 0 : channel];
    return rgb;
}

/// Sets texels that are no radiance to 0 and says how many there were.
std::size_t remove_bad_texels(Image& map) {
    std::size_t bad_count = 0;
    for (std::size_t i = 0; i < map.pixels.size(); i += 3) {
        float* texel = &map.pixels[i];
        const bool good =
            std::all_of(texel, texel + 3, [](float value) { return std::isfinite(value) && value >= 0.0f; });
        if (good) continue;
        std::fill_n(texel, 3, 0.0f);
        ++bad_count;
    }
    return bad_count;
}

Environment load_map(const std::string& file, std::string* warning) {
    Environment environment;
    environment.kind = Environment::Kind::kMap;
    environment.map = to_rgb(read_image(file));
    const Image& map = environment.map;

    std::vector<std::string> warnings;
    if (const std::size_t bad_count = remove_bad_texels(environment.map); bad_count > 0)
        warnings.push_back(std::to_string(bad_count) +
                           " texels are negative, infinite or not a number; they became black");
    const double aspect = double(map.width) / double(map.height);
    if (aspect < 1.8 || aspect > 2.2)
        warnings.push_back("is " + std::to_string(map.width) + " x " + std::to_string(map.height) +
                           ", not about 2:1 as an equirectangular map is");
    if (warning) {
        warning->clear();
        for (const std::string& line : warnings) *warning += (warning->empty() ? one_line(file) + ": " : "; ") + line;
    }
    return environment;
}

glm::vec3 texel(const Image& map, int x, int y) { return glm::make_vec3(map.at(x, y)); }

/// Twin of map_radiance in gpu/environment.glsl.
glm::vec3 map_radiance(const Image& map, glm::vec3 direction) {
    const glm::vec2 size(map.width, map.height);
    const glm::vec2 position = formulas::equirect_from_direction(direction) * size - 0.5f;
    const glm::vec2 corner = glm::floor(position);
    const glm::vec2 weight = position - corner;
    const glm::ivec2 low(corner);
    const int left = low.x < 0 ? map.width - 1 : low.x;
    const int right = low.x + 1 >= map.width ? 0 : low.x + 1;
    const int top = std::clamp(low.y, 0, map.height - 1);
    const int bottom = std::clamp(low.y + 1, 0, map.height - 1);
    const glm::vec3 upper = glm::mix(texel(map, left, top), texel(map, right, top), weight.x);
    const glm::vec3 lower = glm::mix(texel(map, left, bottom), texel(map, right, bottom), weight.x);
    return glm::mix(upper, lower, weight.y);
}

/// The direction in which the environment without rotation holds the light that arrives from world direction `d`.
glm::vec3 environment_from_world(const Environment& environment, glm::vec3 d) {
    const float cosine = std::cos(environment.rotation), sine = std::sin(environment.rotation);
    return {cosine * d.x - sine * d.z, d.y, sine * d.x + cosine * d.z};
}

using Coefficients = std::array<glm::dvec3, 9>;

/// The real spherical harmonics of order 0 to 2.
std::array<double, 9> spherical_harmonics(glm::dvec3 d) {
    return {0.28209479177387814,
            0.48860251190291992 * d.y,
            0.48860251190291992 * d.z,
            0.48860251190291992 * d.x,
            1.0925484305920792 * d.x * d.y,
            1.0925484305920792 * d.y * d.z,
            0.31539156525252005 * (3.0 * d.z * d.z - 1.0),
            1.0925484305920792 * d.x * d.z,
            0.54627421529603959 * (d.x * d.x - d.y * d.y)};
}

void add_sample(Coefficients& sum, glm::dvec3 direction, glm::dvec3 weighted_radiance) {
    const std::array<double, 9> basis = spherical_harmonics(direction);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += basis[i] * weighted_radiance;
}

/// Every texel of the map, weighted by its solid angle.
Coefficients project_map(const Environment& environment) {
    const Image& map = environment.map;
    constexpr double kPiDouble = std::numbers::pi;
    std::vector<glm::dvec2> cos_sin(std::size_t(map.width));
    for (int x = 0; x < map.width; ++x) {
        const double longitude = ((x + 0.5) / map.width - 0.5) * 2.0 * kPiDouble - double(environment.rotation);
        cos_sin[std::size_t(x)] = {std::cos(longitude), std::sin(longitude)};
    }
    Coefficients sum{};
    for (int y = 0; y < map.height; ++y) {
        const double colatitude = (y + 0.5) / map.height * kPiDouble;
        const double half_step = 0.5 * kPiDouble / map.height;
        // Between the two parallels that bound the row, shared by its texels.
        const double solid_angle = 2.0 * std::sin(colatitude) * std::sin(half_step) * (2.0 * kPiDouble / map.width);
        const double weight = solid_angle * double(environment.intensity);
        const double height = std::cos(colatitude), radius = std::sin(colatitude);
        for (int x = 0; x < map.width; ++x) {
            const glm::dvec2 around = cos_sin[std::size_t(x)] * radius;
            add_sample(sum, {around.x, height, around.y}, glm::dvec3(texel(map, x, y)) * weight);
        }
    }
    return sum;
}

/// Points of equal solid angle on a Fibonacci spiral, some twenty of them inside the sun's disc.
Coefficients project_formula(const Environment& environment) {
    constexpr int kSampleCount = 1 << 17;
    constexpr double kGoldenAngle = 2.399963229728653;
    const double solid_angle = 4.0 * std::numbers::pi / kSampleCount;
    Coefficients sum{};
    for (int i = 0; i < kSampleCount; ++i) {
        const double height = 1.0 - (2.0 * i + 1.0) / kSampleCount;
        const double radius = std::sqrt(1.0 - height * height);
        const double longitude = kGoldenAngle * i;
        const glm::dvec3 d(radius * std::cos(longitude), height, radius * std::sin(longitude));
        add_sample(sum, d, glm::dvec3(radiance(environment, glm::vec3(d))) * solid_angle);
    }
    return sum;
}

}  // namespace

Environment load_environment(const std::string& name_or_file, std::string* warning) {
    if (warning) warning->clear();
    for (const auto& [name, kind] : kNames) {
        if (name != name_or_file) continue;
        Environment environment;
        environment.kind = kind;
        return environment;
    }
    const std::string extension = lower_extension(name_or_file);
    if (extension == ".hdr" || extension == ".exr") return load_map(name_or_file, warning);

    std::vector<std::string_view> known;
    for (const auto& entry : kNames) known.push_back(entry.first);
    throw Error(fmt::format("{}, or an equirectangular .hdr or .exr file",
                            unknown_name("environment", name_or_file, known).what()));
}

glm::vec3 radiance(const Environment& environment, glm::vec3 direction) {
    const glm::vec3 d = environment_from_world(environment, direction);
    const bool map = environment.kind == Environment::Kind::kMap;
    const glm::vec3 full =
        map ? map_radiance(environment.map, d)
            : formulas::procedural_radiance(glm::uint(environment.kind), environment.uniform_radiance, d);
    return environment.intensity * full;
}

std::array<glm::vec3, 9> irradiance_coefficients(const Environment& environment) {
    // The clamped cosine scales order l by A_l (Ramamoorthi & Hanrahan 2001, equation 8).
    constexpr double kPiDouble = std::numbers::pi;
    constexpr double kCosineByOrder[] = {kPiDouble, 2.0 * kPiDouble / 3.0, kPiDouble / 4.0};
    const Coefficients sum =
        environment.kind == Environment::Kind::kMap ? project_map(environment) : project_formula(environment);
    std::array<glm::vec3, 9> result;
    for (std::size_t i = 0; i < result.size(); ++i) {
        const std::size_t order = i == 0 ? 0 : i < 4 ? 1 : 2;
        result[i] = glm::vec3(sum[i] * kCosineByOrder[order]);
    }
    return result;
}

}  // namespace pellucid
