#version 460
// Scene-linear radiance to display values for an eye adapted to a luminance (Krawczyk et al. 2005): the photographic
// operator (Reinhard et al. 2002, equation 3) with the key for that luminance. Where rods see, colours fade to a
// bluish grey.
#extension GL_GOOGLE_include_directive : require
#include "shade/adaptation.glsl"
#include "shade/srgb.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, rgba32f) readonly uniform image2DArray radiance;
layout(set = 0, binding = 1, rgba8) writeonly uniform image2DArray display;
layout(std430, set = 0, binding = 2) readonly buffer Adaptation { float adapted_cd_m2; };
layout(push_constant) uniform Push {
    float unit_cd_m2;
    float exposure;  // factor on the key
};

const vec3 kRodTint = vec3(1.05, 0.97, 1.27);  // has luminance 1.008

float key_of(float luminance) { return 1.03 - 2.0 / (2.0 + log2(luminance + 1.0) / log2(10.0)); }

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID.xy, 0);
    if (any(greaterThanEqual(at.xy, imageSize(radiance).xy))) return;
    vec3 cd_m2 = min(max(unit_cd_m2 * imageLoad(radiance, at).rgb, 0.0), kBrightest);
    float luminance = luminance_cd_m2(cd_m2, 1.0);
    float scale = exposure * key_of(adapted_cd_m2) / adapted_cd_m2;
    float factor = scale / (1.0 + scale * luminance);  // displayed luminance / luminance, defined for black too
    vec3 c = factor * mix(cd_m2, luminance * kRodTint, rod_sensitivity(luminance));
    imageStore(display, at, vec4(srgb_from_linear(clamp(c, 0.0, 1.0)), 1.0));
}
