#version 460
// Log-average luminance of the image, and the eye's adaptation after seeing it for a time (Krawczyk et al. 2005): an
// exponential approach in luminance, slower where rods dominate.
#extension GL_GOOGLE_include_directive : require
#define PELLUCID_ADDS_UP
#include "shade/adaptation.glsl"

layout(local_size_x = PELLUCID_ADAPTATION_GROUP) in;

layout(std430, set = 0, binding = 0) readonly buffer TileSums { float tile_sums[]; };
layout(std430, set = 0, binding = 1) buffer Adaptation { float adapted_cd_m2; };
layout(push_constant) uniform Push {
    uint tiles;
    float pixels;
    float elapsed_s;
    uint first;  // 1: there was no earlier image
};

const float kConeTime = 0.1, kRodTime = 0.4;  // s

void main() {
    float sum = 0.0;
    for (uint i = gl_LocalInvocationIndex; i < tiles; i += PELLUCID_ADAPTATION_GROUP) sum += tile_sums[i];
    float mean = exp(sum_of_group(sum) / pixels);
    if (gl_LocalInvocationIndex != 0u) return;
    float time_constant = mix(kConeTime, kRodTime, rod_sensitivity(mean));
    float before = first != 0u ? mean : adapted_cd_m2;
    adapted_cd_m2 = mix(mean, before, exp(-elapsed_s / time_constant));
}
