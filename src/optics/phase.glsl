#ifndef PELLUCID_OPTICS_PHASE_GLSL
#define PELLUCID_OPTICS_PHASE_GLSL

// Scattering in a medium. Twin of phase.h.

// Henyey and Greenstein, Diffuse radiation in the galaxy, 1941: share of scattered light per steradian. `cos_theta`:
// cosine of the scattering angle (1: forward); `g`: its mean.
float henyey_greenstein(float cos_theta, float g) {
    float base = max(1.0 + g * g - 2.0 * g * cos_theta, 1e-6);
    return (1.0 - g * g) / (12.566370614 * base * sqrt(base));
}

#endif
