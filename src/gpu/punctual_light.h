#pragma once

#include "core/math.h"

#include <pellucid/scene.h>

#include <cmath>
#include <cstdint>

namespace pellucid {

/// Twin of PunctualLight in punctual_light.glsl.
struct PunctualLight {
    glm::vec3 position;
    std::uint32_t kind;
    glm::vec3 direction;
    float inverse_range;
    glm::vec3 intensity;
    float radius;  // m, of point and spot lights
    float cos_inner, cos_outer;
    float half_angle;  // radians, of directional lights
    float padding;
};
static_assert(sizeof(PunctualLight) == 64);

inline PunctualLight punctual_light(const Light& light) {
    return {light.position,
            std::uint32_t(light.kind),
            glm::normalize(light.direction),
            std::isfinite(light.range) ? 1.0f / light.range : 0.0f,
            light.intensity,
            light.radius,
            std::cos(light.inner_cone_angle),
            std::cos(light.outer_cone_angle),
            0.5f * light.angular_diameter,
            0.0f};
}

}  // namespace pellucid
