#pragma once

#include "viewer/orbit_camera.h"

#include <pellucid/pellucid.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::viewer {

/// The editable values of a material.
struct MaterialLook {
    float ior = 1.5f;
    float dispersion = 0.0f;  ///< 20 / Abbe number
    float roughness = 0.0f;
    glm::vec3 attenuation_color{1.0f};
    float attenuation_distance = std::numeric_limits<float>::infinity();  ///< m
    glm::vec3 base_color{1.0f};

    bool operator==(const MaterialLook&) const = default;
};
MaterialLook look_of(const Material& material);
void apply(const MaterialLook& look, Material& material);

/// The editable values of a light.
struct LightLook {
    glm::vec3 intensity{1.0f};
    glm::vec3 position{0.0f};
    glm::vec3 direction{0.0f, 0.0f, -1.0f};
    float size = 0.0f;  ///< radius, m; for directional lights the angular diameter, radians

    bool operator==(const LightLook&) const = default;
};
LightLook look_of(const Light& light);
void apply(const LightLook& look, Light& light);

/// All values of the image that the user can change and undo.
struct Look {
    std::string technique = RenderSettings{}.technique;  ///< name of a technique or a preset
    std::string other;                                   ///< technique right of the divider; empty: no divider
    float divider = 0.5f;                                ///< share of the width, 0 to 1
    ParameterMap parameters;
    View view = View::kRadiance;
    std::string overlay;         ///< name from overlay_infos(), shown left of the divider; empty: none
    std::uint32_t samples = 16;  ///< samples of the finished image

    ToneMap tonemap = ToneMap::kNeutral;
    float exposure_ev = 0.0f;
    LightTransport transport = LightTransport::kAutomatic;
    Shadows shadows = Shadows::kExact;
    std::uint32_t bounces = LightOptions{}.bounces;

    std::string environment = "studio";  ///< name or file
    double environment_rotation_deg = 0.0;
    double environment_intensity = 1.0;

    OrbitCamera camera;
    std::string file_camera;              ///< camera of the scene that replaces `camera`; empty: none
    std::vector<MaterialLook> materials;  ///< one per material of the scene
    std::vector<LightLook> lights;        ///< one per light of the scene
    std::optional<std::size_t> animation;
    double time_s = 0.0;  ///< time of the animation

    bool operator==(const Look&) const = default;
};

/// The look of a scene as in its file.
Look look_of(const Scene& scene);

/// The settings of an image. `technique`: one of the look's two techniques.
RenderSettings settings_of(const Look& look, const std::string& technique, std::uint32_t width, std::uint32_t height);

/// The camera of the look. `bounds`: of the scene at rest.
Camera camera_of(const Look& look, const Scene& scene, const Bounds& bounds);

std::string_view tonemap_name(ToneMap tonemap);
std::string_view view_name(View view);

}  // namespace pellucid::viewer
