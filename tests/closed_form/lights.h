#pragma once

// Lights of tests, and what they send through a ball.
#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace pellucid::test {

/// A sun of no size; W/m2.
inline Light sun(glm::vec3 direction, float irradiance) {
    Light light;
    light.kind = Light::Kind::kDirectional;
    light.direction = glm::normalize(direction);
    light.intensity = glm::vec3(irradiance);
    light.angular_diameter = 0.0f;
    return light;
}

/// W/sr; m.
inline Light lamp(glm::vec3 position, float intensity, float radius = 0.0f) {
    Light light;
    light.position = position;
    light.intensity = glm::vec3(intensity);
    light.radius = radius;
    return light;
}

/// Parallel light along -y on a ball of radius 1 around the origin, by rings of equal flux: the flux, per unit of
/// irradiance, that crosses the plane y = -`depth` in rings of width `width` around the axis, after up to 6 reflections.
inline std::vector<double> rings_below_ball(double ior, double depth, double width, std::size_t count) {
    std::vector<double> rings(count);
    constexpr int kRays = 200000;
    const auto land = [&](const glm::dvec2& from, const glm::dvec2& direction, double weight) {
        if (direction.y >= 0.0) return;
        const double rho = std::abs(from.x + direction.x * (depth + from.y) / -direction.y);
        if (rho < width * double(count)) rings[std::size_t(rho / width)] += weight * std::numbers::pi / kRays;
    };
    const auto fresnel = [&](double cos_i, double cos_t) {
        const double s = (cos_i - ior * cos_t) / (cos_i + ior * cos_t),
                     p = (ior * cos_i - cos_t) / (ior * cos_i + cos_t);
        return 0.5 * (s * s + p * p);
    };
    for (int i = 0; i < kRays; ++i) {
        const double h = std::sqrt((i + 0.5) / kRays), cos_i = std::sqrt(1 - h * h),
                     cos_t = std::sqrt(1 - h * h / ior / ior);
        const double theta_i = std::asin(h), theta_t = std::asin(h / ior), r = fresnel(cos_i, cos_t);
        // Angles from +y, clockwise: of the point on the ball, and of the ray's direction.
        const auto at = [](double angle) { return glm::dvec2(std::sin(angle), std::cos(angle)); };
        land(at(theta_i), at(2 * theta_i), r);
        double point = theta_i, weight = 1 - r;
        for (int reflections = 0; reflections <= 6; ++reflections) {
            point += std::numbers::pi - 2 * theta_t;
            land(at(point), at(point + theta_i), weight * (1 - r));
            weight *= r;
        }
    }
    return rings;
}

}  // namespace pellucid::test
