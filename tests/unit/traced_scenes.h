#pragma once

// Scenes for the exact tracer, and what is asked of its paths.
#include "built_scenes.h"

#include <pellucid/reference.h>

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <cstring>
#include <vector>

namespace pellucid::test {

/// Radiance `ahead` straight along -Z and `behind` along +Z: what a slab lets through and throws back.
inline Environment two_sides(glm::vec3 ahead = {1, 0, 0}, glm::vec3 behind = {0, 1, 0}) {
    Environment environment;
    environment.kind = Environment::Kind::kMap;
    environment.map = Image(2, 1, 3);
    for (int c = 0; c < 3; ++c) {
        environment.map.at(0, 0)[c] = ahead[c];
        environment.map.at(1, 0)[c] = behind[c];
    }
    return environment;
}

/// An orthographic camera whose rays all run along `direction`, the middle one through `target`.
inline Camera parallel_camera(glm::vec3 target, glm::vec3 direction, float extent, float distance = 10.0f) {
    Camera camera;
    const glm::vec3 up = std::abs(direction.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
    camera.world_from_view = glm::inverse(glm::lookAt(target - distance * direction, target, up));
    camera.orthographic = true;
    camera.vertical_extent = extent;
    return camera;
}

/// The camera that `pellucid compare` uses.
inline Camera view_of(const Scene& scene, float azimuth_deg) {
    const float fov = 0.5235988f;
    return orbit_camera(scene_bounds(scene), azimuth_deg, 15.0f, framing_distance(fov, 0.7f), fov);
}

inline std::vector<RefractedPath> trace(const Scene& scene, const Camera& camera, std::uint32_t size,
                                        std::uint32_t packet = 1) {
    ExactSettings settings;
    settings.width = settings.height = size;
    settings.packet = packet;
    return Tracer(scene).exact(camera, settings);
}

/// The one path along `direction` through `target`.
inline RefractedPath trace_ray(const Scene& scene, glm::vec3 target, glm::vec3 direction) {
    return trace(scene, parallel_camera(target, direction, 0.01f), 1).front();
}

inline double angle_deg(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(2.0 * std::atan2(glm::length(a - b), glm::length(a + b)));
}

inline bool same_bits(const RefractedPath& a, const RefractedPath& b) {
    return a.direction == b.direction && a.position == b.position && a.transmittance == b.transmittance &&
           a.length_inside == b.length_inside && a.length == b.length && a.object == b.object && a.events == b.events &&
           a.reflections == b.reflections && a.status == b.status && a.side_conflict == b.side_conflict;
}

inline std::size_t count_different(const std::vector<RefractedPath>& a, const std::vector<RefractedPath>& b) {
    std::size_t count = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) count += !same_bits(a[i], b[i]);
    return count;
}

/// Share of the pixels covered by glass in `a` whose directions in `b` are within `tolerance_deg`.
inline double agreement(const std::vector<RefractedPath>& a, const std::vector<RefractedPath>& b,
                        double tolerance_deg) {
    double covered = 0, alike = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (a[i].events == 0) continue;
        ++covered;
        alike += b[i].events > 0 && angle_deg(a[i].direction, b[i].direction) <= tolerance_deg;
    }
    return alike / covered;
}

/// A surface that scatters all light evenly: an index of 1 has no coat.
inline Material matt(glm::vec3 albedo) {
    Material material;
    material.base_color = glm::vec4(albedo, 1.0f);
    material.roughness = 1.0f;
    material.ior = 1.0f;
    return material;
}
inline Material matt(float albedo) { return matt(glm::vec3(albedo)); }

/// A horizontal square of 2 `half` metres at height `y` that faces up.
inline Mesh floor_at(float y, float half = 50.0f) {
    Mesh mesh;
    mesh.positions = {{-half, y, half}, {half, y, half}, {half, y, -half}, {-half, y, -half}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.normals.assign(4, {0, 1, 0});
    mesh.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    return mesh;
}

}  // namespace pellucid::test
