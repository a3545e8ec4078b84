#pragma once

// GGX facets whose width differs along two axes: Heitz, "Understanding the masking-shadowing function in microfacet-based
// BRDFs", 2014, section 5.3, and "Sampling the GGX distribution of visible normals", 2018. Directions as in microfacet.h,
// with the x axis along `alpha_x`.

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid::reference {

struct StretchedFacets {
    double alpha_x = 0.0, alpha_y = 0.0;  ///< both above 0

    double density(const glm::dvec3& m) const {
        const double x = m.x / alpha_x, y = m.y / alpha_y, d = x * x + y * y + m.z * m.z;
        return 1.0 / (std::numbers::pi * alpha_x * alpha_y * d * d);
    }
    double lambda(const glm::dvec3& w) const {
        const double x = alpha_x * w.x, y = alpha_y * w.y;
        return 0.5 * (std::sqrt(1.0 + (x * x + y * y) / std::max(w.z * w.z, 1e-300)) - 1.0);
    }
    double masking(const glm::dvec3& w) const { return 1.0 / (1.0 + lambda(w)); }
    double masking_shadowing(const glm::dvec3& wo, const glm::dvec3& wi) const {
        return 1.0 / (1.0 + lambda(wo) + lambda(wi));
    }
    /// A normal in proportion to what `w`, with w.z > 0, sees of it.
    glm::dvec3 sample_visible(const glm::dvec3& w, const glm::dvec2& u) const {
        const glm::dvec3 v = glm::normalize(glm::dvec3(alpha_x * w.x, alpha_y * w.y, w.z));
        const double length2 = v.x * v.x + v.y * v.y;
        const glm::dvec3 across =
            length2 > 0.0 ? glm::dvec3(-v.y, v.x, 0.0) / std::sqrt(length2) : glm::dvec3(1.0, 0.0, 0.0);
        const double radius = std::sqrt(u.x), angle = 2.0 * std::numbers::pi * u.y, share = 0.5 * (1.0 + v.z);
        const double x = radius * std::cos(angle);
        const double y = (1.0 - share) * std::sqrt(std::max(1.0 - x * x, 0.0)) + share * radius * std::sin(angle);
        const glm::dvec3 m = x * across + y * glm::cross(v, across) + std::sqrt(std::max(1.0 - x * x - y * y, 0.0)) * v;
        return glm::normalize(glm::dvec3(alpha_x * m.x, alpha_y * m.y, std::max(m.z, 1e-12)));
    }
};

}  // namespace pellucid::reference
