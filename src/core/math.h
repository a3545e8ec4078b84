#pragma once

// The only header that configures GLM.
#include <glm/glm.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <numbers>

namespace pellucid {

inline constexpr float kPi = std::numbers::pi_v<float>;

constexpr float radians_from_degrees(float degrees) { return degrees * (kPi / 180.0f); }
constexpr float degrees_from_radians(float radians) { return radians * (180.0f / kPi); }

}  // namespace pellucid
