#include "options/arguments.h"

#include "options/orbit_about.h"

#include <pellucid/file.h>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace pellucid::cli {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == separator)
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

constexpr std::string_view kOrbit = "orbit:";

}  // namespace

double parse_number(const std::string& what, const std::string& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
        throw Error(fmt::format("{}: '{}' is not a number", what, text));
    }
    return value;
}

std::vector<double> parse_numbers(const std::string& what, const std::string& text, std::size_t count) {
    std::vector<double> values;
    for (const std::string& part : split(text, ',')) values.push_back(parse_number(what, part));
    if (values.size() != count)
        throw Error(fmt::format("{}: '{}' should be {} numbers with commas", what, text, count));
    return values;
}

std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& text) {
    const std::vector<std::string> parts = split(text, 'x');
    std::uint32_t size[2] = {0, 0};
    bool ok = parts.size() == 2;
    for (std::size_t i = 0; ok && i < 2; ++i) {
        const char* end = parts[i].data() + parts[i].size();
        const auto parsed = std::from_chars(parts[i].data(), end, size[i]);
        ok = parsed.ec == std::errc() && parsed.ptr == end && size[i] > 0;
    }
    if (!ok) throw Error(fmt::format("--size: '{}' should be WIDTHxHEIGHT in pixels, like 512x512", text));
    return {size[0], size[1]};
}

std::pair<std::string, std::string> parse_aov(const std::string& text) {
    const std::size_t equals = text.find('=');
    const std::string file = equals == std::string::npos ? "" : text.substr(equals + 1);
    if (lower_extension(file) != ".exr") throw Error(fmt::format("--aov: '{}' should be NAME=FILE.exr", text));
    return {text.substr(0, equals), file};
}

Camera parse_camera(const std::string& text, const Scene& scene, float vertical_fov) {
    if (text.starts_with(kOrbit)) {
        const std::string numbers = text.substr(kOrbit.size());
        const bool about_centre = std::count(numbers.begin(), numbers.end(), ',') < 3;
        const std::vector<double> orbit = parse_numbers("--camera", numbers, about_centre ? 3 : 6);
        if (!(std::abs(orbit[1]) <= 90.0))
            throw Error(fmt::format("--camera: elevation {} is not -90 to 90 degrees", orbit[1]));
        const Bounds bounds = scene_bounds(scene);
        if (about_centre) {
            if (!(orbit[2] > 1.0)) throw Error(fmt::format("--camera: distance {} is not above 1 radius", orbit[2]));
            return orbit_camera(bounds, float(orbit[0]), float(orbit[1]), float(orbit[2]), vertical_fov);
        }
        if (!(orbit[2] >= double(kLeastDistance)))
            throw Error(fmt::format("--camera: distance {} is below {} radii", orbit[2], kLeastDistance));
        const glm::vec3 target = glm::dvec3(orbit[3], orbit[4], orbit[5]) - scene.origin;
        return orbit_about(bounds, target, float(orbit[0]), float(orbit[1]), float(orbit[2]), vertical_fov);
    }
    std::vector<std::string_view> known;
    for (const Camera& camera : scene.cameras) {
        if (camera.name == text) return camera;
        known.push_back(camera.name);
    }
    known.push_back("orbit:AZ,EL,DIST[,X,Y,Z]");
    throw unknown_name("camera", text, known);
}

std::string shell_quoted(const std::string& argument) {
    const bool plain = !argument.empty() && argument.find_first_not_of(
                                                "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                                "-_=./:,+@%") == std::string::npos;
    if (plain) return argument;
    std::string quoted = "'";
    for (const char c : argument) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

}  // namespace pellucid::cli
