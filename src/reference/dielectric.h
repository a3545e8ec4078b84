#pragma once

// A smooth boundary between two dielectrics, for the reference tracer. It is independent of the renderer's optics, so
// that agreement between the two is evidence.
// Born & Wolf, Principles of Optics, 7th ed. (1999), section 1.5.
//
// `d` is the unit direction of travel, and `n` the unit normal on the side that the light comes from. An interpolated
// normal may face away from that side; the incidence is then treated as grazing.

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>

namespace pellucid::reference {

/// Light incident on the boundary from a medium of index n_i to one of index n_t.
struct Incidence {
    double cos_i = 0.0;      ///< 0..1
    double cos_t = 0.0;      ///< 0..1; 0 under total reflection
    bool total = false;      ///< no light is transmitted
    bool conflict = false;   ///< `n` faced away from the light
    double reflectance = 1;  ///< reflected share of unpolarised light, 0..1
};

/// Reflected share of unpolarised light: mean of the squared amplitudes of the polarisations across and in the plane
/// of incidence.
inline double fresnel_reflectance(double n_i, double cos_i, double n_t, double cos_t) {
    if (n_i == n_t) return 0.0;  // includes grazing incidence, where both amplitudes are 0 / 0
    const double across = (n_i * cos_i - n_t * cos_t) / (n_i * cos_i + n_t * cos_t);
    const double within = (n_i * cos_t - n_t * cos_i) / (n_i * cos_t + n_t * cos_i);
    return 0.5 * (across * across + within * within);
}

inline Incidence incidence(const glm::dvec3& d, const glm::dvec3& n, double n_i, double n_t) {
    const double cosine = -glm::dot(d, n);
    Incidence in;
    in.conflict = cosine < 0.0;
    in.cos_i = std::clamp(cosine, 0.0, 1.0);
    // Snell's law gives sin_t. Equal indices keep the angle bit for bit.
    const double sin_i = std::sqrt((1.0 - in.cos_i) * (1.0 + in.cos_i));
    const double sin_t = sin_i * (n_i / n_t);
    in.total = sin_t > 1.0;
    if (in.total) return in;
    in.cos_t = n_i == n_t ? in.cos_i : std::sqrt((1.0 - sin_t) * (1.0 + sin_t));
    in.reflectance = fresnel_reflectance(n_i, in.cos_i, n_t, in.cos_t);
    return in;
}

/// The component of `d` along the surface shrinks by n_i / n_t; the other follows from unit length.
inline glm::dvec3 refracted(const glm::dvec3& d, const glm::dvec3& n, double n_i, double n_t, const Incidence& in) {
    if (n_i == n_t) return d;
    const glm::dvec3 along = (n_i / n_t) * (d + in.cos_i * n);
    return glm::normalize(along - in.cos_t * n);
}

inline glm::dvec3 reflected(const glm::dvec3& d, const glm::dvec3& n, const Incidence& in) {
    return glm::normalize(d + 2.0 * in.cos_i * n);
}

}  // namespace pellucid::reference
