#include "render/photon_lighting.h"

#include "gpu/gpu_scene.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

/// Twin of mirrors() in end_photons.comp.
bool mirrors(const Material& material) {
    return !material.transmissive() && !material.unlit && material.metallic > 0.0f && material.roughness < 0.3f &&
           material.metallic_roughness_texture.image < 0;
}

/// Corners of the boxes of what bends light, eight each.
std::vector<glm::vec3> target_corners(const Scene& scene) {
    std::vector<glm::vec3> corners;
    for (const Object& object : scene.objects) {
        const Material& material = scene.materials[std::size_t(object.material)];
        if (material.refractive() || mirrors(material))
            append_box_corners(scene.meshes[std::size_t(object.mesh)], object.world_from_object, corners);
    }
    return corners;
}

/// Boxes that are wider by `margin`, m, on all sides.
std::vector<glm::vec3> widened(std::vector<glm::vec3> corners, float margin) {
    for (std::size_t first = 0; first < corners.size(); first += 8) {
        const glm::vec3 middle = 0.5f * (corners[first] + corners[first + 7]);
        for (std::size_t i = first; i < first + 8; ++i)
            corners[i] += margin * (2.0f * glm::vec3(glm::greaterThan(corners[i], middle)) - 1.0f);
    }
    return corners;
}

/// How far a light's rays reach past the targets that its middle sees, m.
float margin_of(const Light& light, const glm::vec3& low, const glm::vec3& high) {
    if (light.kind != Light::Kind::kDirectional) return light.radius;
    return 0.5f * glm::distance(low, high) * std::tan(0.5f * light.angular_diameter);
}

std::vector<LightView> views_of(const Light& light, std::uint32_t number, const std::vector<glm::vec3>& targets,
                                const Bounds& bounds, std::uint32_t side) {
    glm::vec3 low = targets.front(), high = low;
    for (const glm::vec3& corner : targets) low = glm::min(low, corner), high = glm::max(high, corner);
    auto views = light_views(light, number, widened(targets, margin_of(light, low, high)), bounds, side);
    for (LightView& view : views) {
        // Faces of a cube meet at their edges.
        if (view.face != LightView::kWhole)
            view.constants.film = glm::vec4(-1.0f, 1.0f, 2.0f / float(side), 2.0f / float(side));
        view.target_depth = -(view.constants.view_from_world * glm::vec4(0.5f * (low + high), 1.0f)).z;
    }
    return views;
}

}  // namespace

float scene_brightness(const Scene& scene, const Bounds& bounds, const gpu::FrameConstants& environment) {
    constexpr float kMean = 0.282095f;  // irradiance of the first harmonic
    const auto largest = [](const glm::vec3& color) { return std::max({color.r, color.g, color.b}); };
    float sum = kMean * largest(glm::abs(glm::vec3(environment.irradiance[0])));
    const float radius = std::max(bounds.radius, 1e-6f);
    for (const Light& light : scene.lights)
        sum += largest(light.intensity) / (light.kind == Light::Kind::kDirectional ? 1.0f : radius * radius);
    for (const Object& object : scene.objects)
        sum = std::max(sum, largest(scene.materials[std::size_t(object.material)].emission));
    return std::max(sum, 1e-20f);
}

PhotonSetup photon_setup(const Scene& scene, const Bounds& bounds, std::uint32_t count) {
    PhotonSetup setup{.lights = scene.lights};
    if (count == 0) return setup;
    const std::vector<glm::vec3> targets = target_corners(scene);
    if (targets.empty()) return setup;
    // One side for all views: a light that needs several shares its photons out among them.
    const auto all_views = [&](std::uint32_t side) {
        std::vector<LightView> views;
        for (std::uint32_t light = 0; light < scene.lights.size(); ++light) {
            const auto own = views_of(scene.lights[light], light, targets, bounds, side);
            views.insert(views.end(), own.begin(), own.end());
        }
        return views;
    };
    const auto side_for = [&](std::size_t views) {
        const double texels = double(count) * double(scene.lights.size()) / double(std::max<std::size_t>(views, 1));
        return std::max(std::uint32_t(std::sqrt(texels)), 2u);
    };
    setup.views = all_views(side_for(all_views(2).size()));
    return setup;
}

}  // namespace pellucid
