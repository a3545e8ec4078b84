#include "reference/punctual_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid::reference {

double cone_share(const Light& light, double cos_angle) {
    const double cos_inner = std::cos(double(light.inner_cone_angle));
    const double cos_outer = std::cos(double(light.outer_cone_angle));
    if (cos_angle <= cos_outer) return 0.0;
    if (cos_angle >= cos_inner) return 1.0;
    const double ramp = (cos_angle - cos_outer) / (cos_inner - cos_outer);
    return ramp * ramp;
}

double range_share(const Light& light, double distance) {
    const double relative = distance / double(light.range);
    return std::clamp(1.0 - relative * relative * relative * relative, 0.0, 1.0);
}

std::optional<ArrivingLight> arriving_light(const Light& light, const glm::dvec3& position) {
    ArrivingLight arriving;
    if (light.kind == Light::Kind::kDirectional) {
        arriving.direction = -glm::normalize(glm::dvec3(light.direction));
        arriving.distance = std::numeric_limits<double>::infinity();
        arriving.irradiance = light.intensity;
        return arriving;
    }
    const glm::dvec3 to_light = glm::dvec3(light.position) - position;
    arriving.distance = glm::length(to_light);
    if (!(arriving.distance > 0.0)) return std::nullopt;
    arriving.direction = to_light / arriving.distance;
    double share = range_share(light, arriving.distance);
    if (light.kind == Light::Kind::kSpot) {
        share *= cone_share(light, -glm::dot(arriving.direction, glm::normalize(glm::dvec3(light.direction))));
    }
    if (!(share > 0.0)) return std::nullopt;
    arriving.irradiance = glm::dvec3(light.intensity) * (share / (arriving.distance * arriving.distance));
    return arriving;
}

}  // namespace pellucid::reference
