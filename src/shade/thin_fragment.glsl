#ifndef PELLUCID_SHADE_THIN_FRAGMENT_GLSL
#define PELLUCID_SHADE_THIN_FRAGMENT_GLSL

// A pane of thin-walled glass in front of all opaque and refracting surfaces.
#extension GL_GOOGLE_include_directive : require
#include "shade/surface_fragment.glsl"
#include "optics/interface.glsl"

layout(set = 0, binding = 5, r32f) readonly uniform image2DArray opaque_depth;
layout(set = 0, binding = 6, r32f) readonly uniform image2DArray layer_depth;

bool hidden() {
    ivec3 at = ivec3(gl_FragCoord.xy, 0);
    return eye_depth() >= min(imageLoad(opaque_depth, at).r, imageLoad(layer_depth, at).r);
}

// Coverage of the pane: alpha, if the material uses it as coverage, else 1.
float coverage(MaterialRecord material, vec4 base) {
    return (material.flags & PELLUCID_MATERIAL_COVERAGE) != 0u ? base.a : 1.0;
}

// Reflectance of a pane with two faces and all reflections between them: 2 R / (1 + R).
float pane_reflectance(vec3 normal, vec3 view_direction, float ior) {
    float r = fresnel_dielectric(-dot(view_direction, normal), 1.0 / ior);
    return 2.0 * r / (1.0 + r);
}

#endif
