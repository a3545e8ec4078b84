#include "render/photon_lighting.h"

#include "gpu/emitters.h"
#include "gpu/gpu_scene.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace pellucid {
namespace {

/// Twin of reflects_photons() in photon_mirrors.glsl.
bool mirrors(const Material& material) {
    return !material.transmissive() && !material.unlit && material.metallic > 0.0f && material.roughness < 0.3f &&
           material.metallic_roughness_texture.image < 0 && material.normal_texture.image < 0 &&
           material.finish.plain();
}

bool bends_light(const Material& material) { return material.refractive() || mirrors(material); }

/// Corners of the boxes of the selected objects, eight each.
std::vector<glm::vec3> corners_of(const Scene& scene, bool (*wanted)(const Material&)) {
    std::vector<glm::vec3> corners;
    for (const Object& object : scene.objects) {
        if (wanted(scene.materials[std::size_t(object.material)]))
            append_box_corners(scene.meshes[std::size_t(object.mesh)], object.world_from_object, corners);
    }
    return corners;
}

struct Box {
    glm::vec3 low, high;
};
Box box_around(std::span<const glm::vec3> points) {
    Box box{points.front(), points.front()};
    for (const glm::vec3& p : points) box.low = glm::min(box.low, p), box.high = glm::max(box.high, p);
    return box;
}

/// Sphere around everything that bends light.
PhotonSetup::Sphere sphere_around(const Scene& scene, const Box& box) {
    PhotonSetup::Sphere sphere{0.5f * (box.low + box.high), 0.0f};
    for (const Object& object : scene.objects) {
        if (!bends_light(scene.materials[std::size_t(object.material)])) continue;
        for (const glm::vec3& p : scene.meshes[std::size_t(object.mesh)].positions) {
            const glm::vec3 at(object.world_from_object * glm::vec4(p, 1.0f));
            sphere.radius = std::max(sphere.radius, glm::distance(at, sphere.center));
        }
    }
    sphere.radius *= 1.0001f;  // include surfaces that touch the sphere
    return sphere;
}

/// True if the box of an emissive object overlaps that of a refracting object.
bool emits_in_solids(const Scene& scene) {
    const auto refractive = corners_of(scene, [](const Material& material) { return material.refractive(); });
    const auto emissive = corners_of(scene, emits_light);
    for (std::size_t i = 0; i < emissive.size(); i += 8) {
        const Box own = box_around(std::span(emissive).subspan(i, 8));
        for (std::size_t j = 0; j < refractive.size(); j += 8) {
            const Box other = box_around(std::span(refractive).subspan(j, 8));
            if (glm::all(glm::lessThanEqual(own.low, other.high)) && glm::all(glm::lessThanEqual(other.low, own.high)))
                return true;
        }
    }
    return false;
}

/// Boxes enlarged by `margin`, m, on all sides.
std::vector<glm::vec3> widened(std::vector<glm::vec3> corners, float margin) {
    for (std::size_t first = 0; first < corners.size(); first += 8) {
        const glm::vec3 middle = 0.5f * (corners[first] + corners[first + 7]);
        for (std::size_t i = first; i < first + 8; ++i)
            corners[i] += margin * (2.0f * glm::vec3(glm::greaterThan(corners[i], middle)) - 1.0f);
    }
    return corners;
}

/// Distance, m, by which a light's rays extend beyond the targets seen from its centre.
float margin_of(const Light& light, const glm::vec3& low, const glm::vec3& high) {
    if (light.kind != Light::Kind::kDirectional) return light.radius;
    return 0.5f * glm::distance(low, high) * std::tan(0.5f * light.angular_diameter);
}

std::vector<LightView> views_of(const Light& light, std::uint32_t number, const std::vector<glm::vec3>& targets,
                                const Bounds& bounds, std::uint32_t side) {
    const Box box = box_around(targets);
    auto views = light_views(light, number, widened(targets, margin_of(light, box.low, box.high)), bounds, side);
    for (LightView& view : views) {
        // Adjacent faces of a cube must share their edges.
        if (view.face != LightView::kWhole)
            view.constants.film = glm::vec4(-1.0f, 1.0f, 2.0f / float(side), 2.0f / float(side));
        view.target_depth = -(view.constants.view_from_world * glm::vec4(0.5f * (box.low + box.high), 1.0f)).z;
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

PhotonSetup photon_setup(const Scene& scene, const Bounds& bounds, const PhotonSources& sources, std::uint32_t count) {
    PhotonSetup setup;
    if (count == 0 || !(sources.lights || sources.emitters || sources.environment != nullptr)) return setup;
    const std::vector<glm::vec3> targets = corners_of(scene, bends_light);
    if (targets.empty()) return setup;
    if (sources.lights) setup.lights = scene.lights;
    setup.emitters = sources.emitters;
    setup.emitters_in_solids = sources.emitters && emits_in_solids(scene);
    setup.environment = sources.environment;
    setup.targets = sphere_around(scene, box_around(targets));
    // All windows have equal sides. A light with several views distributes its photons among them.
    const auto all_views = [&](std::uint32_t side) {
        std::vector<LightView> views;
        for (std::uint32_t light = 0; light < setup.lights.size(); ++light) {
            const auto own = views_of(setup.lights[light], light, targets, bounds, side);
            views.insert(views.end(), own.begin(), own.end());
        }
        return views;
    };
    setup.views = all_views(2);
    const std::size_t windows = setup.window_count(), others = windows - setup.views.size();
    const double texels =
        double(count) * double(setup.lights.size() + others) / double(std::max<std::size_t>(windows, 1));
    setup.side = std::max(std::uint32_t(std::sqrt(texels)), 2u);
    setup.views = all_views(setup.side);
    return setup;
}

}  // namespace pellucid
