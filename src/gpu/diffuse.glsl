#ifndef PELLUCID_GPU_DIFFUSE_GLSL
#define PELLUCID_GPU_DIFFUSE_GLSL

// Radiance that a diffuse surface reflects from the environment. Needs: frame (FrameConstants).
#include "scene/irradiance.glsl"

vec3 diffuse_radiance(vec3 albedo, vec3 normal) {
    vec3 coefficients[9];
    for (int i = 0; i < 9; ++i) coefficients[i] = frame.irradiance[i].rgb;
    return albedo * irradiance_from_coefficients(coefficients, normal) / 3.14159265;
}

#endif
