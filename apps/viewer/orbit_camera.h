#pragma once

#include <pellucid/scene.h>

#include <cstdint>

namespace pellucid::viewer {

/// A camera that looks at a point of the scene, without roll.
struct OrbitCamera {
    glm::vec3 target{0.0f};       ///< world, m
    float azimuth_deg = 0.0f;     ///< as in pellucid::orbit_camera()
    float elevation_deg = 15.0f;  ///< -90 to 90
    float distance = 3.0f;        ///< from the target, in radii of the scene
    float fov_deg = 30.0f;        ///< vertical

    bool operator==(const OrbitCamera&) const = default;
};

/// The camera that frames a scene in an image of the given size, as pellucid::framing_camera() does.
OrbitCamera framing_orbit(const Bounds& bounds, std::uint32_t width, std::uint32_t height, float fov_deg = 30.0f);

/// The orbit camera with the same position and direction, whose target is the point on the view axis nearest to the
/// scene's centre. Roll is lost. An orthographic camera becomes a perspective camera that shows the same extent at the
/// target.
OrbitCamera orbit_from_camera(const Camera& camera, const Bounds& bounds);

Camera camera_of(const OrbitCamera& orbit, const Bounds& bounds);

/// Rotates the camera around its target. The elevation stops at the poles.
void turn(OrbitCamera& orbit, float azimuth_deg, float elevation_deg);
/// Divides the distance by `factor`, > 0.
void zoom(OrbitCamera& orbit, float factor);
/// Moves camera and target so that the image moves by the given shares of its height, right and down.
void pan(OrbitCamera& orbit, const Bounds& bounds, float right, float down);
/// Moves camera and target along the camera's axes, in radii of the scene.
void fly(OrbitCamera& orbit, const Bounds& bounds, const glm::vec3& right_up_forward);
/// Rotates the camera around its own position, which moves the target.
void look_around(OrbitCamera& orbit, const Bounds& bounds, float azimuth_deg, float elevation_deg);

}  // namespace pellucid::viewer
