#include <pellucid/error.h>
#include <pellucid/scene.h>

#include "core/math.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

void check_fov(float vertical_fov) {
    if (!(vertical_fov > 0.0f && vertical_fov < kPi))
        throw Error(fmt::format("vertical field of view {} degrees: must be between 0 and 180",
                                degrees_from_radians(vertical_fov)));
}

}  // namespace

Camera orbit_camera(const Bounds& bounds, float azimuth_deg, float elevation_deg, float distance, float vertical_fov) {
    check_fov(vertical_fov);
    if (!std::isfinite(azimuth_deg)) throw Error("azimuth of the camera must be finite");
    if (!(std::abs(elevation_deg) <= 90.0f))
        throw Error(fmt::format("elevation {} degrees: must be within -90..90", elevation_deg));
    if (!(distance > 1.0f) || !std::isfinite(distance))
        throw Error(fmt::format("distance {} radii: must be greater than 1", distance));

    const double azimuth = glm::radians(double(azimuth_deg));
    const double elevation = glm::radians(double(elevation_deg));
    // Angles instead of a look-at vector, so that looking straight down is no special case.
    const glm::dvec3 right(std::cos(azimuth), 0.0, -std::sin(azimuth));
    const glm::dvec3 back(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                          std::cos(azimuth) * std::cos(elevation));
    const glm::dvec3 up = glm::cross(back, right);
    const glm::dvec3 eye = glm::dvec3(bounds.center) + back * double(distance) * double(bounds.radius);

    Camera camera;
    camera.name = "orbit";
    camera.vertical_fov = vertical_fov;
    camera.world_from_view =
        glm::mat4(glm::vec4(right, 0.0f), glm::vec4(up, 0.0f), glm::vec4(back, 0.0f), glm::vec4(eye, 1.0f));
    return camera;
}

float framing_distance(float vertical_fov, float share) {
    check_fov(vertical_fov);
    if (!(share > 0.0f && share < 1.0f))
        throw Error(fmt::format("share {} of the image height: must be between 0 and 1", share));
    // The sphere's silhouette is a tangent cone of half angle h, with sin h = radius / distance. On the image plane it
    // covers tan h of the half height tan(fov / 2).
    const double half_angle = std::atan(double(share) * std::tan(0.5 * double(vertical_fov)));
    return static_cast<float>(1.0 / std::sin(half_angle));
}

Camera framing_camera(const Bounds& bounds, std::uint32_t width, std::uint32_t height, float vertical_fov) {
    const float share = 0.7f * std::min(1.0f, float(width) / float(height));
    return orbit_camera(bounds, 0.0f, 15.0f, framing_distance(vertical_fov, share), vertical_fov);
}

}  // namespace pellucid
