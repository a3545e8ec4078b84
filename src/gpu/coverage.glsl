#ifndef PELLUCID_GPU_COVERAGE_GLSL
#define PELLUCID_GPU_COVERAGE_GLSL

// Opaque surfaces that are there in part: every sample sees them or not, at random (Enderton, Sintorn, Shirley & Luebke,
// "Stochastic transparency", 2010). Needs: frame.
#include "gpu/hash.glsl"

// Below 0 where a ray of that pixel, of the whole picture, sees a hole in the triangle. `alpha`: of the point; `ray`: tells
// the pixel's rays apart, 0 for the one from the eye.
float alpha_margin(MaterialRecord material, float alpha, ivec2 pixel, uint triangle, uint ray) {
    bool partial = (material.flags & PELLUCID_MATERIAL_COVERAGE) != 0u && material.transmission == 0.0;
    if (!partial || alpha >= 1.0) return alpha - material.alpha_cutoff;
    uvec3 number = hash(uvec3(uint(pixel.x) | uint(pixel.y) << 16u, triangle + 0x9e3779b9u * ray, frame.sample_index));
    return alpha - (float(number.x >> 8u) + 0.5) / 16777216.0;
}

#endif
