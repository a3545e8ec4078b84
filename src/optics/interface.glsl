#ifndef PELLUCID_OPTICS_INTERFACE_GLSL
#define PELLUCID_OPTICS_INTERFACE_GLSL

// Light at a smooth boundary between two dielectrics, and inside one.
// Snell's law in vector form; Fresnel's equations from Born & Wolf, Principles of Optics,
// 7th ed. (1999), section 1.5.2; Beer-Lambert absorption; dispersion as in the glTF extension
// KHR_materials_dispersion. Twin of interface.h: same functions and formulas.
//
// `direction` (D) is the unit direction in which light or a view ray travels. `normal` (N) is the unit surface normal
// on the incident side, so cos_theta_i = -D.N >= 0. eta = n_incident / n_transmitted.

// Cosine of the angle of incidence, clamped to 0..1. An interpolated normal can point away from the incident side;
// this counts as grazing incidence.
float incident_cosine(vec3 direction, vec3 normal) {
    return clamp(-dot(direction, normal), 0.0, 1.0);
}

// Square of the cosine of the angle of refraction; negative under total internal reflection.
// Same as `1 - eta^2 (1 - cos_theta_i^2)`, arranged so that eta = 1 gives exactly cos_theta_i^2.
float transmitted_cosine_squared(float cos_theta_i, float eta) {
    return (1.0 - eta) * (1.0 + eta) + eta * eta * cos_theta_i * cos_theta_i;
}

// Snell's law. Returns true and the unit refracted direction. Returns false under total internal reflection;
// `refracted` is then the reflected direction, never undefined.
bool refract_direction(vec3 direction, vec3 normal, float eta, out vec3 refracted) {
    float cos_theta_i = incident_cosine(direction, normal);
    float cos_squared_t = transmitted_cosine_squared(cos_theta_i, eta);
    if (cos_squared_t < 0.0) {  // total internal reflection
        refracted = normalize(direction + 2.0 * cos_theta_i * normal);
        return false;
    }
    refracted = normalize(eta * direction + (eta * cos_theta_i - sqrt(cos_squared_t)) * normal);
    return true;
}

// Mirror reflection; unit length.
vec3 reflect_direction(vec3 direction, vec3 normal) {
    return normalize(direction + 2.0 * incident_cosine(direction, normal) * normal);
}

// Reflectance of a smooth dielectric boundary for unpolarised light, 0..1; the rest is refracted. cos_theta_i is
// clamped to 0..1.
float fresnel_dielectric(float cos_theta_i, float eta) {
    if (eta == 1.0) return 0.0;  // equal media: no boundary, even at grazing incidence
    cos_theta_i = clamp(cos_theta_i, 0.0, 1.0);
    float cos_squared_t = transmitted_cosine_squared(cos_theta_i, eta);
    if (cos_squared_t < 0.0) return 1.0;  // total internal reflection
    float cos_theta_t = sqrt(cos_squared_t);
    float s = (eta * cos_theta_i - cos_theta_t) / (eta * cos_theta_i + cos_theta_t);
    float p = (eta * cos_theta_t - cos_theta_i) / (eta * cos_theta_t + cos_theta_i);
    return 0.5 * (s * s + p * p);
}

// Transmittance over `distance` metres per channel (Beer-Lambert). sigma_a per metre, 0..infinity. It is 1 if the
// distance or the absorption is 0, even if the other is infinite.
vec3 beer_lambert(vec3 sigma_a, float distance) {
    // 0 times infinity is NaN, so limit both factors. 1e30 avoids infinity, which some drivers drop; exp(-1e30 d) is 0
    // for any visible d.
    vec3 optical_depth = min(sigma_a, vec3(1e30)) * clamp(distance, 0.0, 1e8);
    return exp(-max(optical_depth, vec3(0.0)));
}

// Index of refraction for red, green and blue, at the Fraunhofer C (656.3 nm), d (587.6 nm) and F (486.1 nm) lines,
// which define Abbe's number. `ior`: index at the d line; `dispersion`: 20 / Abbe number. No index falls below 1.
vec3 ior_per_channel(float ior, float dispersion) {
    float half_spread = (ior - 1.0) * 0.025 * dispersion;
    return vec3(max(ior - half_spread, 1.0), ior, ior + half_spread);
}

#endif
