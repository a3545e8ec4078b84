#include "viewer/orbit_camera.h"

#include "options/orbit_about.h"

#include <algorithm>
#include <cmath>

namespace pellucid::viewer {
namespace {

constexpr float kMostDistance = 1000.0f;

float limited(float distance) { return std::clamp(distance, cli::kLeastDistance, kMostDistance); }

}  // namespace

OrbitCamera framing_orbit(const Bounds& bounds, std::uint32_t width, std::uint32_t height, float fov_deg) {
    const float fov = glm::radians(fov_deg);
    const Camera framing = framing_camera(bounds, width, height, fov);
    OrbitCamera orbit{.target = bounds.center, .fov_deg = fov_deg};
    // Only framing_camera() knows the distance: the scene's share of the height shrinks in narrow images.
    orbit.distance = bounds.radius > 0.0f
                         ? glm::distance(glm::vec3(framing.world_from_view[3]), bounds.center) / bounds.radius
                         : 3.0f;
    return orbit;
}

OrbitCamera orbit_from_camera(const Camera& camera, const Bounds& bounds) {
    const glm::vec3 back = glm::normalize(glm::vec3(camera.world_from_view[2]));
    const glm::vec3 eye = camera.world_from_view[3];
    OrbitCamera orbit;
    orbit.elevation_deg = glm::degrees(std::asin(std::clamp(back.y, -1.0f, 1.0f)));
    const glm::vec3 right = camera.world_from_view[0];
    orbit.azimuth_deg = glm::degrees(std::atan2(-right.z, right.x));
    orbit.fov_deg = glm::degrees(camera.vertical_fov);
    const float radius = std::max(bounds.radius, 1e-6f);
    float distance = std::max(glm::dot(eye - bounds.center, back), 0.1f * radius);
    orbit.target = eye - distance * back;
    if (camera.orthographic) {
        orbit.fov_deg = 30.0f;
        distance = 0.5f * camera.vertical_extent / std::tan(glm::radians(15.0f));
    }
    orbit.distance = limited(distance / radius);
    return orbit;
}

Camera camera_of(const OrbitCamera& orbit, const Bounds& bounds) {
    return cli::orbit_about(bounds, orbit.target, orbit.azimuth_deg, orbit.elevation_deg, orbit.distance,
                            glm::radians(orbit.fov_deg));
}

void turn(OrbitCamera& orbit, float azimuth_deg, float elevation_deg) {
    orbit.azimuth_deg = std::remainder(orbit.azimuth_deg + azimuth_deg, 360.0f);
    orbit.elevation_deg = std::clamp(orbit.elevation_deg + elevation_deg, -90.0f, 90.0f);
}

void zoom(OrbitCamera& orbit, float factor) { orbit.distance = limited(orbit.distance / factor); }

void pan(OrbitCamera& orbit, const Bounds& bounds, float right, float down) {
    const glm::mat4 world_from_view = camera_of(orbit, bounds).world_from_view;
    const float height =
        // height at the target, m
        2.0f * orbit.distance * bounds.radius * std::tan(0.5f * glm::radians(orbit.fov_deg));
    orbit.target += height * (down * glm::vec3(world_from_view[1]) - right * glm::vec3(world_from_view[0]));
}

void fly(OrbitCamera& orbit, const Bounds& bounds, const glm::vec3& right_up_forward) {
    const glm::mat3 axes(camera_of(orbit, bounds).world_from_view);
    orbit.target += bounds.radius * (axes * (right_up_forward * glm::vec3(1.0f, 1.0f, -1.0f)));
}

void look_around(OrbitCamera& orbit, const Bounds& bounds, float azimuth_deg, float elevation_deg) {
    const glm::vec3 eye = camera_of(orbit, bounds).world_from_view[3];
    turn(orbit, azimuth_deg, elevation_deg);
    orbit.target += eye - glm::vec3(camera_of(orbit, bounds).world_from_view[3]);
}

}  // namespace pellucid::viewer
