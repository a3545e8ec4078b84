#include "viewer/equal_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ranges>

namespace pellucid::viewer {
namespace {

class CommandLine {
public:
    explicit CommandLine(std::string start) : line_(std::move(start)) {}

    void word(const std::string& text) { line_ += " " + shell_word(text); }
    template <class Value>
    void option(std::string_view flag, const Value& value) {
        word(fmt::format("--{}", flag));
        word(fmt::format("{}", value));
    }
    template <class Value>
    void option(std::string_view flag, const std::optional<Value>& value) {
        if (value) option(flag, *value);
    }
    void each(std::string_view flag, const std::vector<std::string>& values) {
        for (const std::string& value : values) option(flag, value);
    }
    /// Leaves out what is the default anyway.
    template <class Value>
    void changed(std::string_view flag, const Value& value, const Value& by_default) {
        if (!(value == by_default)) option(flag, value);
    }
    std::string take() { return std::move(line_); }

private:
    std::string line_;
};

std::string rgb(const glm::vec3& color) { return fmt::format("{},{},{}", color.r, color.g, color.b); }

/// The options that the scene was loaded with, without those that `look` has changed.
void add_loading(CommandLine& line, const cli::SceneArguments& how, const Look& look) {
    line.option("crease-angle", how.crease_angle_deg);
    if (how.remake_normals) line.word("--remake-normals");
    if (how.solid) line.word("--solid");
    if (how.allow_outside) line.word("--allow-outside");
    line.each("priority", how.priorities);
    line.option("translucent", how.translucency.translucent);
    line.each("add-light", how.translucency.lights);
    line.each("map", how.volumes.grids);
    line.each("add-volume", how.volumes.added);
    if (look.animation) {
        line.option("animation", *look.animation);
        line.option("time", look.time_s);
    } else {
        line.option("animation", how.animation);
        line.option("time", how.time_s);
    }
}

/// One value of all refracting materials, as the options about all glass set it; none where they differ.
template <class Value>
std::optional<Value> common(const Scene& scene, const Look& look, Value MaterialLook::*member) {
    std::optional<Value> value;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (!scene.materials[i].refractive()) continue;
        if (value && !(*value == look.materials[i].*member)) return std::nullopt;
        value = look.materials[i].*member;
    }
    return value;
}

/// Indices and absorption of all glass alike are options; everything else about materials is not.
void add_materials(CommandLine& line, const Look& look, const Scene& scene, const cli::SceneArguments& how,
                   std::vector<std::string>& lacking) {
    std::optional<float> ior, distance;
    std::optional<glm::vec3> color;
    std::vector<MaterialLook> said;
    for (const Material& material : scene.materials) said.push_back(look_of(material));
    const auto say = [&](auto MaterialLook::*member, auto& value) {
        const bool differs = std::ranges::any_of(std::views::iota(std::size_t(0), said.size()), [&](std::size_t i) {
            return !(said[i].*member == look.materials[i].*member);
        });
        if (differs) value = common(scene, look, member);
        for (std::size_t i = 0; value && i < said.size(); ++i)
            if (scene.materials[i].refractive()) said[i].*member = *value;
    };
    say(&MaterialLook::ior, ior);
    say(&MaterialLook::attenuation_color, color);
    say(&MaterialLook::attenuation_distance, distance);
    if (distance && !std::isfinite(*distance)) {
        distance.reset();
        lacking.emplace_back("an infinite attenuation distance");
    }
    if (ior)
        line.option("ior", *ior);
    else
        line.option("ior", how.ior);
    if (color)
        line.option("attenuation-color", rgb(*color));
    else
        line.option("attenuation-color", how.attenuation_color);
    if (distance)
        line.option("attenuation-distance", *distance);
    else
        line.option("attenuation-distance", how.attenuation_distance);
    for (std::size_t i = 0; i < said.size(); ++i) {
        if (!(said[i] == look.materials[i]))
            lacking.push_back(fmt::format("changes of material {} '{}'", i, one_line(scene.materials[i].name)));
    }
}

void add_camera(CommandLine& line, const Look& look, const Scene& scene) {
    if (!look.file_camera.empty()) {
        if (look.file_camera != scene.cameras.front().name) line.option("camera", look.file_camera);
        return;
    }
    const OrbitCamera& orbit = look.camera;
    std::string camera = fmt::format("orbit:{},{},{}", orbit.azimuth_deg, orbit.elevation_deg, orbit.distance);
    if (orbit.target != scene_bounds(scene).center || orbit.distance <= 1.0f) {
        const glm::dvec3 target = glm::dvec3(orbit.target) + scene.origin;
        camera += fmt::format(",{},{},{}", target.x, target.y, target.z);
    }
    line.option("camera", camera);
    line.changed("fov", orbit.fov_deg, OrbitCamera{}.fov_deg);
}

}  // namespace

std::string shell_word(const std::string& text) {
    const auto plain = [](unsigned char c) {
        return std::isalnum(c) || std::string_view("-_=./:,+@%").find(char(c)) != std::string_view::npos;
    };
    if (!text.empty() && std::all_of(text.begin(), text.end(), plain)) return text;
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

EqualCommand equal_command(const Look& look, const Scene& scene, const cli::SceneArguments& how, std::uint32_t width,
                           std::uint32_t height) {
    EqualCommand command;
    const Look by_default;
    CommandLine line("pellucid render");
    line.word(scene.source);
    line.word("-o");
    line.word("image.png");
    line.word("--size");
    line.word(fmt::format("{}x{}", width, height));
    line.option("technique", look.technique);
    for (const auto& [name, value] : look.parameters) line.option(name, value);
    line.option("samples", look.samples);
    add_camera(line, look, scene);
    line.changed("environment", look.environment, by_default.environment);
    line.changed("environment-rotation", look.environment_rotation_deg, 0.0);
    line.changed("environment-intensity", look.environment_intensity, 1.0);
    line.changed("view", view_name(look.view), view_name(View::kRadiance));
    line.changed("tonemap", tonemap_name(look.tonemap), tonemap_name(by_default.tonemap));
    line.changed("exposure", look.exposure_ev, 0.0f);
    line.changed("light", light_transport_name(look.transport), light_transport_name(by_default.transport));
    if (look.shadows == Shadows::kTinted) line.option("shadows", "tinted");
    line.changed("bounces", look.bounces, by_default.bounces);
    add_loading(line, how, look);
    add_materials(line, look, scene, how, command.lacking);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        if (!(look_of(scene.lights[i]) == look.lights[i]))
            command.lacking.push_back(fmt::format("changes of light {} '{}'", i, one_line(scene.lights[i].name)));
    }
    if (!look.other.empty()) command.lacking.push_back(fmt::format("technique {} right of the divider", look.other));
    if (!look.overlay.empty()) command.lacking.push_back(fmt::format("overlay {}", look.overlay));
    command.line = line.take();
    return command;
}

}  // namespace pellucid::viewer
