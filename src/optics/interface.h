#pragma once

// Light at a smooth boundary between two dielectrics, and inside one.
// Snell's law in vector form; Fresnel's equations from Born & Wolf, Principles of Optics,
// 7th ed. (1999), section 1.5.2; Beer-Lambert absorption; dispersion as in the glTF extension
// KHR_materials_dispersion. Twin of interface.glsl: same functions and formulas.
//
// `direction` (D) is the unit direction in which light or a view ray travels. `normal` (N) is the unit surface normal
// on the incident side, so cos_theta_i = -D.N >= 0. eta = n_incident / n_transmitted.

#include "core/math.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace pellucid {

/// The vector type of the twins: glm::vec3 or glm::dvec3.
template <class Real>
using Vec3 = glm::vec<3, Real, glm::defaultp>;

/// Cosine of the angle of incidence, clamped to 0..1. An interpolated normal can point away from the incident side;
/// this counts as grazing incidence.
template <class Real>
Real incident_cosine(Vec3<Real> direction, Vec3<Real> normal) {
    return std::clamp(-glm::dot(direction, normal), Real(0), Real(1));
}

/// Square of the cosine of the angle of refraction; negative under total internal reflection.
/// Same as `1 - eta^2 (1 - cos_theta_i^2)`, arranged so that eta = 1 gives exactly cos_theta_i^2.
template <class Real>
Real transmitted_cosine_squared(Real cos_theta_i, Real eta) {
    return (Real(1) - eta) * (Real(1) + eta) + eta * eta * cos_theta_i * cos_theta_i;
}

/// Snell's law. Writes the unit refracted direction to `refracted` and returns true. Under total internal reflection
/// it returns false and does not change `refracted`.
template <class Real>
bool refract_direction(Vec3<Real> direction, Vec3<Real> normal, std::type_identity_t<Real> eta, Vec3<Real>& refracted) {
    const Real cos_theta_i = incident_cosine(direction, normal);
    const Real cos_squared_t = transmitted_cosine_squared(cos_theta_i, Real(eta));
    if (cos_squared_t < Real(0)) return false;  // total internal reflection
    refracted = glm::normalize(eta * direction + (eta * cos_theta_i - std::sqrt(cos_squared_t)) * normal);
    return true;
}

/// Mirror reflection; unit length.
template <class Real>
Vec3<Real> reflect_direction(Vec3<Real> direction, Vec3<Real> normal) {
    return glm::normalize(direction + Real(2) * incident_cosine(direction, normal) * normal);
}

/// Reflectance of a smooth dielectric boundary for unpolarised light, 0..1; the rest is refracted. cos_theta_i is
/// clamped to 0..1.
template <class Real>
Real fresnel_dielectric(Real cos_theta_i, std::type_identity_t<Real> eta) {
    if (eta == Real(1)) return Real(0);  // equal media: no boundary, even at grazing incidence
    cos_theta_i = std::clamp(cos_theta_i, Real(0), Real(1));
    const Real cos_squared_t = transmitted_cosine_squared(cos_theta_i, Real(eta));
    if (cos_squared_t < Real(0)) return Real(1);  // total internal reflection
    const Real cos_theta_t = std::sqrt(cos_squared_t);
    const Real s = (eta * cos_theta_i - cos_theta_t) / (eta * cos_theta_i + cos_theta_t);
    const Real p = (eta * cos_theta_t - cos_theta_i) / (eta * cos_theta_t + cos_theta_i);
    return Real(0.5) * (s * s + p * p);
}

/// Transmittance over `distance` metres per channel (Beer-Lambert). sigma_a per metre, 0..infinity. It is 1 if the
/// distance or the absorption is 0, even if the other is infinite.
template <class Real>
Vec3<Real> beer_lambert(Vec3<Real> sigma_a, std::type_identity_t<Real> distance) {
    Vec3<Real> transmittance(1);
    for (int channel = 0; channel < 3; ++channel) {
        // 0 times infinity is NaN, so test both factors before the product.
        if (sigma_a[channel] > Real(0) && distance > Real(0))
            transmittance[channel] = std::exp(-sigma_a[channel] * distance);
    }
    return transmittance;
}

/// Index of refraction for red, green and blue, at the Fraunhofer C (656.3 nm), d (587.6 nm) and F (486.1 nm) lines,
/// which define Abbe's number. `ior`: index at the d line; `dispersion`: 20 / Abbe number. No index falls below 1.
template <class Real>
Vec3<Real> ior_per_channel(Real ior, std::type_identity_t<Real> dispersion) {
    const Real half_spread = (ior - Real(1)) * Real(0.025) * dispersion;
    return {std::max(ior - half_spread, Real(1)), ior, ior + half_spread};
}

}  // namespace pellucid
