#pragma once

#include <pellucid/scene.h>

namespace pellucid::cli {

/// Smallest distance from the point that an orbit camera looks at, in radii of the scene.
inline constexpr float kLeastDistance = 0.002f;

/// orbit_camera() about a point of the scene, which may be nearer to it than one radius. About the centre of `bounds`: equal to
/// orbit_camera(), bit for bit.
inline Camera orbit_about(const Bounds& bounds, const glm::vec3& target, float azimuth_deg, float elevation_deg,
                          float distance, float vertical_fov) {
    // A power of two keeps the product of radius and distance as it is.
    constexpr float kShrink = 1024.0f;
    return orbit_camera({target, bounds.radius / kShrink, bounds.half_size}, azimuth_deg, elevation_deg,
                        distance * kShrink, vertical_fov);
}

}  // namespace pellucid::cli
