#include "viewer/saved_state.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace pellucid::viewer {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormat = 1;

Json vec3_json(const glm::vec3& v) { return {v.x, v.y, v.z}; }
glm::vec3 vec3_of(const Json& json) {
    return {json.at(0).get<float>(), json.at(1).get<float>(), json.at(2).get<float>()};
}

Json camera_json(const OrbitCamera& camera) {
    return {{"target", vec3_json(camera.target)},
            {"azimuth_deg", camera.azimuth_deg},
            {"elevation_deg", camera.elevation_deg},
            {"distance", camera.distance},
            {"fov_deg", camera.fov_deg}};
}

OrbitCamera camera_of(const Json& json) {
    OrbitCamera camera;
    camera.target = vec3_of(json.at("target"));
    turn(camera, json.at("azimuth_deg").get<float>(), json.at("elevation_deg").get<float>() - camera.elevation_deg);
    camera.distance = json.at("distance").get<float>();
    zoom(camera, 1.0f);  // clamps the distance to its limits
    camera.fov_deg = std::clamp(json.at("fov_deg").get<float>(), 1.0f, 170.0f);
    return camera;
}

// null represents infinity, which JSON does not have.
Json material_json(const MaterialLook& m) {
    Json json{{"ior", m.ior},
              {"dispersion", m.dispersion},
              {"roughness", m.roughness},
              {"attenuation_color", vec3_json(m.attenuation_color)},
              {"attenuation_distance", nullptr},
              {"base_color", vec3_json(m.base_color)}};
    if (std::isfinite(m.attenuation_distance)) json["attenuation_distance"] = m.attenuation_distance;
    return json;
}

MaterialLook material_of(const Json& json) {
    MaterialLook m;
    m.ior = json.at("ior").get<float>();
    m.dispersion = json.at("dispersion").get<float>();
    m.roughness = json.at("roughness").get<float>();
    m.attenuation_color = vec3_of(json.at("attenuation_color"));
    if (!json.at("attenuation_distance").is_null()) m.attenuation_distance = json["attenuation_distance"].get<float>();
    m.base_color = vec3_of(json.at("base_color"));
    return m;
}

Json light_json(const LightLook& light) {
    return {{"intensity", vec3_json(light.intensity)},
            {"position", vec3_json(light.position)},
            {"direction", vec3_json(light.direction)},
            {"size", light.size}};
}

LightLook light_of(const Json& json) {
    return {vec3_of(json.at("intensity")), vec3_of(json.at("position")), vec3_of(json.at("direction")),
            json.at("size").get<float>()};
}

Json look_json(const Look& look) {
    Json json{{"technique", look.technique},
              {"other", look.other},
              {"divider", look.divider},
              {"parameters", look.parameters},
              {"view", view_name(look.view)},
              {"overlay", look.overlay},
              {"samples", look.samples},
              {"tonemap", tonemap_name(look.tonemap)},
              {"exposure_ev", look.exposure_ev},
              {"light", light_transport_name(look.transport)},
              {"shadows", look.shadows == Shadows::kTinted ? "tinted" : "exact"},
              {"bounces", look.bounces},
              {"environment", look.environment},
              {"environment_rotation_deg", look.environment_rotation_deg},
              {"environment_intensity", look.environment_intensity},
              {"camera", camera_json(look.camera)},
              {"file_camera", look.file_camera},
              {"materials", Json::array()},
              {"lights", Json::array()},
              {"time_s", look.time_s}};
    for (const MaterialLook& material : look.materials) json["materials"].push_back(material_json(material));
    for (const LightLook& light : look.lights) json["lights"].push_back(light_json(light));
    if (look.animation) json["animation"] = *look.animation;
    return json;
}

Look look_of(const Json& json) {
    Look look;
    const auto read = [&](const char* name, auto& value) {
        if (json.contains(name)) json[name].get_to(value);
    };
    const auto name = [&](const char* key, std::string_view by_default) {
        return json.value(key, std::string(by_default));
    };
    read("technique", look.technique);
    read("other", look.other);
    read("divider", look.divider);
    read("parameters", look.parameters);
    look.view = parse_view(name("view", "radiance"));
    read("overlay", look.overlay);
    read("samples", look.samples);
    look.tonemap = parse_tonemap(name("tonemap", "neutral"));
    read("exposure_ev", look.exposure_ev);
    look.transport = parse_light_transport(name("light", "automatic"));
    look.shadows = parse_shadows(name("shadows", "exact"));
    read("bounces", look.bounces);
    read("environment", look.environment);
    read("environment_rotation_deg", look.environment_rotation_deg);
    read("environment_intensity", look.environment_intensity);
    if (json.contains("camera")) look.camera = camera_of(json["camera"]);
    read("file_camera", look.file_camera);
    for (const Json& material : json.value("materials", Json::array())) look.materials.push_back(material_of(material));
    for (const Json& light : json.value("lights", Json::array())) look.lights.push_back(light_of(light));
    if (json.contains("animation")) look.animation = json["animation"].get<std::size_t>();
    read("time_s", look.time_s);
    if (look.samples < 1) throw Error("0 samples");
    check_technique_name(look.technique);
    if (!look.other.empty()) check_technique_name(look.other);
    return look;
}

}  // namespace

std::filesystem::path state_file() {
    const char* state = std::getenv("XDG_STATE_HOME");
    const char* home = std::getenv("HOME");
    std::filesystem::path folder;
    if (state != nullptr && *state == '/')  // the specification requires ignoring relative paths
        folder = state;
    else if (home != nullptr && *home != '\0')
        folder = std::filesystem::path(home) / ".local/state";
    else
        return {};
    return folder / "pellucid/viewer.json";
}

std::string to_json(const SavedState& state) {
    const Json json{{"format", kFormat},      {"scene", state.scene},   {"width", state.width},
                    {"height", state.height}, {"panels", state.panels}, {"look", look_json(state.look)}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

SavedState from_json(const std::string& text) {
    try {
        const Json json = Json::parse(text);
        if (json.at("format").get<int>() != kFormat) throw Error("is of another version of the viewer");
        SavedState state;
        state.scene = json.at("scene").get<std::string>();
        state.width = std::clamp(json.at("width").get<std::uint32_t>(), 64u, 16384u);
        state.height = std::clamp(json.at("height").get<std::uint32_t>(), 64u, 16384u);
        state.panels = json.at("panels").get<bool>();
        state.look = look_of(json.at("look"));
        return state;
    } catch (const Json::exception& error) {
        throw Error(fmt::format("is no state of the viewer: {}", error.what()));
    }
}

}  // namespace pellucid::viewer
