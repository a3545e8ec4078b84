#pragma once

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <optional>

namespace pellucid::reference {

/// Light of a point, spot or directional light as it arrives at a point, if nothing is in between.
struct ArrivingLight {
    glm::dvec3 direction{0.0};   ///< unit, towards the light
    double distance = 0.0;       ///< m; infinite for a directional light
    glm::dvec3 irradiance{0.0};  ///< W/m2 on a surface that faces it
};

/// KHR_lights_punctual (Khronos Group, glTF 2.0 extension), sections "Inner and Outer Cone Angles" and
/// "Range Property", with their recommended falloffs. Nothing where no light arrives.
std::optional<ArrivingLight> arriving_light(const Light& light, const glm::dvec3& position);

/// Share of a spot's intensity in a direction whose cosine to its axis is `cos_angle`: the square of a ramp in the
/// cosine from the outer to the inner angle.
double cone_share(const Light& light, double cos_angle);

/// Share that is left after `distance`, m: fades the light out towards its range, so that it has no edge there.
double range_share(const Light& light, double distance);

}  // namespace pellucid::reference
