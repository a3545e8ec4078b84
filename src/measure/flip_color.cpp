// Colour spaces of FLIP: Andersson et al. 2020, sections 4.1.1 and 4.1.3.
#include "measure/flip_color.h"

#include "core/math.h"

#include <cmath>

namespace pellucid {
namespace {

/// CIE XYZ of a chromaticity, for Y = 1.
glm::dvec3 xyz_from_xy(double x, double y) { return {x / y, 1.0, (1.0 - x - y) / y}; }

/// CIE XYZ from linear Rec.709 (ITU-R BT.709: primaries, and the white point D65), relative to the XYZ of its white.
/// White is (1, 1, 1) in both spaces.
glm::mat3 relative_xyz_from_linear() {
    const glm::dmat3 primaries(xyz_from_xy(0.64, 0.33), xyz_from_xy(0.30, 0.60), xyz_from_xy(0.15, 0.06));
    const glm::dvec3 white = xyz_from_xy(0.3127, 0.3290);
    const glm::dvec3 strength = glm::inverse(primaries) * white;
    glm::mat3 result;
    for (int i = 0; i < 3; ++i) result[i] = glm::vec3(primaries[i] * strength[i] / white);
    return result;
}

const glm::mat3 kXyzFromLinear = relative_xyz_from_linear();
const glm::mat3 kLinearFromXyz = glm::inverse(relative_xyz_from_linear());

/// Curve of CIE 15, L*a*b*: cube root, and below (6/29)^3 its tangent.
float lab_curve(float t) {
    constexpr float kDelta = 6.0f / 29.0f;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
}

}  // namespace

// L*a*b* without the cube root.
glm::vec3 opponent_from_linear(glm::vec3 linear) {
    const glm::vec3 xyz = kXyzFromLinear * linear;
    return {116.0f * xyz.y - 16.0f, 500.0f * (xyz.x - xyz.y), 200.0f * (xyz.y - xyz.z)};
}

glm::vec3 perceived_from_opponent(glm::vec3 opponent) {
    const float y = (opponent.x + 16.0f) / 116.0f;
    const glm::vec3 shown =
        glm::clamp(kLinearFromXyz * glm::vec3(y + opponent.y / 500.0f, y, y - opponent.z / 200.0f), 0.0f, 1.0f);
    const glm::vec3 xyz = kXyzFromLinear * shown;
    const glm::vec3 f(lab_curve(xyz.x), lab_curve(xyz.y), lab_curve(xyz.z));
    const float lightness = 116.0f * f.y - 16.0f;
    const float hunt = 0.01f * lightness;
    return {lightness, hunt * 500.0f * (f.x - f.y), hunt * 200.0f * (f.y - f.z)};
}

float perceived_distance(glm::vec3 a, glm::vec3 b) {
    const glm::vec3 d = a - b;
    return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

}  // namespace pellucid
