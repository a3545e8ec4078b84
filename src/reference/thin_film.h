#pragma once

#include <glm/glm.hpp>

namespace pellucid::reference {

/// Reflectance, RGB 0..1, of a surface under a film in air, whose thickness is of the order of wavelengths: Belcour & Barla,
/// "A practical extension to microfacet theory for the modeling of varying iridescence", 2017, with the Fresnel terms of
/// Schlick that KHR_materials_iridescence has. `at_normal`: reflectance of the surface head-on, without the film.
glm::dvec3 film_reflectance(double cos_theta, double film_ior, double thickness_nm, const glm::dvec3& at_normal);

}  // namespace pellucid::reference
