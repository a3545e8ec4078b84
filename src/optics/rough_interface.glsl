#ifndef PELLUCID_OPTICS_ROUGH_INTERFACE_GLSL
#define PELLUCID_OPTICS_ROUGH_INTERFACE_GLSL

// Scattering by a rough boundary of two dielectrics, with all light between its microfacets: Heitz, Hanika,
// d'Eon & Dachsbacher, "Multiple-scattering microfacet BSDFs with the Smith model", 2016.
//
// Twin of RoughInterface::sample() in src/reference/rough_interface.h: the same random walk, step by step, with
// the same density of directions. That header defines `level`. The twins differ in precision and in two bounds:
// here levels stay above kLowestLevel and a walk meets at most 64 facets. Of 3.6e7 walks of the C++ twin none
// met more than 22.
//
// The file that includes this one defines `float next_random()`: uniform, 0 <= x < 1.

#include "optics/interface.glsl"

float next_random();

const int kMostFacets = 64;
const float kLowestLevel = 1e-7;  // about the distance from 1 to the float below

// Smith's auxiliary function for GGX, of a direction on either side.
float smith_lambda(vec3 w, float alpha) {
    float cos2 = max(w.z * w.z, 1e-20);
    float t = alpha * alpha * max(1.0 - cos2, 0.0) / cos2;
    return 0.5 * t / (sqrt(1.0 + t) + 1.0);  // (sqrt(1 + t) - 1) / 2 without the cancellation
}

// A GGX normal that w sees, w on either side: Heitz, "Sampling the GGX distribution of visible normals", 2018,
// listing 1.
vec3 sample_visible_normal(vec3 w, float alpha) {
    vec3 stretched = normalize(vec3(alpha * w.xy, w.z));
    float length2 = dot(stretched.xy, stretched.xy);
    vec3 across = length2 > 0.0 ? vec3(-stretched.y, stretched.x, 0.0) * inversesqrt(length2) : vec3(1.0, 0.0, 0.0);
    vec3 along = cross(stretched, across);
    float radius = sqrt(next_random()), angle = 6.28318530718 * next_random();
    float x = radius * cos(angle), share = 0.5 * (1.0 + stretched.z);
    float y = (1.0 - share) * sqrt(max(1.0 - x * x, 0.0)) + share * radius * sin(angle);
    vec3 m = x * across + y * along + sqrt(max(1.0 - x * x - y * y, 0.0)) * stretched;
    return normalize(vec3(alpha * m.xy, max(m.z, 1e-7)));
}

// Moves a ray at `level` to the next facet. False if it leaves the microsurface.
bool reaches_facet(vec3 direction, float alpha, inout float level) {
    float clear = 1.0 - next_random();
    float lambda = smith_lambda(direction, alpha);
    if (direction.z > 0.0) {
        if (clear <= pow(level, lambda)) return false;
        level *= pow(clear, -1.0 / lambda);
    } else {
        level *= pow(clear, 1.0 / (1.0 + lambda));
    }
    level = clamp(level, kLowestLevel, 1.0);
    return true;
}

// Samples the direction in which light goes on that travels in `direction`. The frame's z axis is the surface's
// normal on the side that the light comes from, so direction.z < 0. alpha > 0 is the square of the perceptual
// roughness, eta = n_incident / n_transmitted. `transmitted`: the light ends on the other side, at z <= 0.
// The sample weighs 1 (times the tint, if transmitted).
vec3 sample_rough_interface(vec3 direction, float alpha, float eta, out bool transmitted) {
    // Below the surface the frame is turned over, so that z always points away from the surface.
    vec3 w = direction;
    float level = 1.0, eta_here = eta;
    transmitted = false;
    for (int facet = 0; facet < kMostFacets && reaches_facet(w, alpha, level); ++facet) {
        vec3 m = sample_visible_normal(-w, alpha);
        if (next_random() < fresnel_dielectric(-dot(w, m), eta_here)) {
            w = reflect_direction(w, m);
            continue;
        }
        vec3 refracted;
        refract_direction(w, m, eta_here, refracted);
        w = vec3(refracted.xy, -refracted.z);
        level = max(1.0 - level, kLowestLevel);
        eta_here = 1.0 / eta_here;
        transmitted = !transmitted;
    }
    w.z = abs(w.z);  // A walk that reached the bound can point at the surface.
    return transmitted ? vec3(w.xy, -w.z) : w;
}

#endif
