#pragma once

#include <glm/glm.hpp>

namespace pellucid::reference {

/// BRDF of white fibres for two directions above the surface: Estevez & Kulla, "Production friendly microfacet sheen BRDF",
/// 2017. `roughness` 0..1 is perceptual.
double sheen(const glm::dvec3& wo, const glm::dvec3& wi, double roughness);

/// Share of even light that they reflect in a direction with that cosine; it can be above 1 at grazing angles.
double sheen_albedo(double cos_theta, double roughness);

}  // namespace pellucid::reference
