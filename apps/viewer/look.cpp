#include "viewer/look.h"

#include <algorithm>

namespace pellucid::viewer {

MaterialLook look_of(const Material& material) {
    return {material.ior,
            material.dispersion,
            material.roughness,
            material.attenuation_color,
            material.attenuation_distance,
            glm::vec3(material.base_color)};
}

void apply(const MaterialLook& look, Material& material) {
    material.ior = look.ior;
    material.dispersion = look.dispersion;
    material.roughness = look.roughness;
    material.attenuation_color = look.attenuation_color;
    material.attenuation_distance = look.attenuation_distance;
    material.base_color = glm::vec4(look.base_color, material.base_color.a);
}

LightLook look_of(const Light& light) {
    const bool directional = light.kind == Light::Kind::kDirectional;
    return {light.intensity, light.position, light.direction, directional ? light.angular_diameter : light.radius};
}

void apply(const LightLook& look, Light& light) {
    light.intensity = look.intensity;
    light.position = look.position;
    light.direction = look.direction;
    (light.kind == Light::Kind::kDirectional ? light.angular_diameter : light.radius) = look.size;
}

Look look_of(const Scene& scene) {
    Look look;
    for (const Material& material : scene.materials) look.materials.push_back(look_of(material));
    for (const Light& light : scene.lights) look.lights.push_back(look_of(light));
    if (!scene.cameras.empty()) look.file_camera = scene.cameras.front().name;
    return look;
}

RenderSettings settings_of(const Look& look, const std::string& technique, std::uint32_t width, std::uint32_t height) {
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    settings.technique = technique;
    settings.view = look.view;
    settings.samples = look.samples;
    settings.tonemap = look.tonemap;
    settings.exposure_ev = look.exposure_ev;
    settings.light.transport = look.transport;
    settings.light.shadows = look.shadows;
    settings.light.bounces = look.bounces;
    settings.parameters = look.parameters;
    return settings;
}

Camera camera_of(const Look& look, const Scene& scene, const Bounds& bounds) {
    const auto named = [&](const Camera& camera) { return camera.name == look.file_camera; };
    if (const auto found = std::find_if(scene.cameras.begin(), scene.cameras.end(), named);
        !look.file_camera.empty() && found != scene.cameras.end())
        return *found;
    return camera_of(look.camera, bounds);
}

std::string_view tonemap_name(ToneMap tonemap) {
    switch (tonemap) {
        case ToneMap::kNone:
            return "none";
        case ToneMap::kReinhard:
            return "reinhard";
        case ToneMap::kAces:
            return "aces";
        case ToneMap::kNeutral:
            return "neutral";
        case ToneMap::kKrawczyk:
            return "krawczyk";
    }
    return "neutral";
}

std::string_view view_name(View view) {
    switch (view) {
        case View::kRadiance:
            return "radiance";
        case View::kAnalysis:
            return "analysis";
        case View::kWavefront:
            return "wavefront";
    }
    return "radiance";
}

}  // namespace pellucid::viewer
