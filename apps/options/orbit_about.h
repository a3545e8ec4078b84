#pragma once

#include <pellucid/scene.h>

namespace pellucid::cli {

/// Least distance of an orbit camera from its target, in radii of the scene.
inline constexpr float kLeastDistance = 0.002f;

/// orbit_camera() around a point of the scene, at a distance that may be below one radius. Around the centre of
/// `bounds` it equals orbit_camera() bit for bit.
inline Camera orbit_about(const Bounds& bounds, const glm::vec3& target, float azimuth_deg, float elevation_deg,
                          float distance, float vertical_fov) {
    // A power of two keeps the product of radius and distance exact.
    constexpr float kShrink = 1024.0f;
    return orbit_camera({target, bounds.radius / kShrink, bounds.half_size}, azimuth_deg, elevation_deg,
                        distance * kShrink, vertical_fov);
}

}  // namespace pellucid::cli
