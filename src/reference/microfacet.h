#pragma once

// The distribution of microfacet normals of Trowbridge and Reitz ("GGX") with Smith's shadowing:
// Walter, Marschner, Li & Torrance, "Microfacet models for refraction through rough surfaces", 2007;
// Heitz, "Understanding the masking-shadowing function in microfacet-based BRDFs", 2014, and
// "Sampling the GGX distribution of visible normals", 2018.
//
// Directions are unit, in a frame whose z axis is the surface normal, and point away from the surface.

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid::reference {

struct Microfacets {
    double alpha = 0.0;  ///< width, 0..1: square of the perceptual roughness

    /// Surfaces with a smaller width count as perfect mirrors: their lobe is narrower than 0.01 degrees.
    static constexpr double kSmooth = 1e-4;
    bool smooth() const { return alpha < kSmooth; }

    /// Density of normals m (m.z > 0) per solid angle and projected area.
    double density(const glm::dvec3& m) const {
        const double a2 = alpha * alpha;
        const double d = (m.x * m.x + m.y * m.y) + a2 * m.z * m.z;
        return a2 / (std::numbers::pi * d * d);
    }

    /// Smith's auxiliary function, for a direction on either side.
    double lambda(const glm::dvec3& w) const {
        const double cos2 = w.z * w.z;
        if (cos2 >= 1.0) return 0.0;
        return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 - cos2) / std::max(cos2, 1e-300)) - 1.0);
    }
    /// Share of facets visible from w.
    double masking(const glm::dvec3& w) const { return 1.0 / (1.0 + lambda(w)); }
    /// Share of facets visible from both directions, with correlated heights (Heitz 2014, equation 99).
    double masking_shadowing(const glm::dvec3& wo, const glm::dvec3& wi) const {
        return 1.0 / (1.0 + lambda(wo) + lambda(wi));
    }

    /// Projected area along w of the facets that face w, per macroscopic area. w may point below the surface.
    double projected_area(const glm::dvec3& w) const {
        const double cos2 = w.z * w.z;
        const double slanted = std::sqrt(cos2 + alpha * alpha * std::max(1.0 - cos2, 0.0));
        // Below the horizon the sum would cancel; use the equivalent quotient.
        if (w.z < 0.0) return 0.5 * alpha * alpha * std::max(1.0 - cos2, 0.0) / (slanted - w.z);
        return 0.5 * (slanted + w.z);
    }

    /// Samples a normal visible from w, with the density max(dot(w, m), 0) density(m) / projected_area(w) per solid
    /// angle (Heitz 2018, listing 1). w may point below the surface, because the listing also samples the hemisphere
    /// visible from there.
    glm::dvec3 sample_visible(const glm::dvec3& w, const glm::dvec2& u) const {
        const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * w.x, alpha * w.y, w.z));
        const double length2 = stretched.x * stretched.x + stretched.y * stretched.y;
        const glm::dvec3 across =
            length2 > 0.0 ? glm::dvec3(-stretched.y, stretched.x, 0.0) / std::sqrt(length2) : glm::dvec3(1.0, 0.0, 0.0);
        const glm::dvec3 along = glm::cross(stretched, across);
        // Point on the disc that is the projected hemisphere of normals, with its hidden part compressed to zero.
        const double radius = std::sqrt(u.x), angle = 2.0 * std::numbers::pi * u.y;
        const double x = radius * std::cos(angle);
        const double share = 0.5 * (1.0 + stretched.z);
        const double y = (1.0 - share) * std::sqrt(std::max(1.0 - x * x, 0.0)) + share * radius * std::sin(angle);
        const glm::dvec3 m = x * across + y * along + std::sqrt(std::max(1.0 - x * x - y * y, 0.0)) * stretched;
        return glm::normalize(glm::dvec3(alpha * m.x, alpha * m.y, std::max(m.z, 1e-12)));
    }
};

}  // namespace pellucid::reference
