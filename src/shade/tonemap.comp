#version 460
// Scene-linear radiance to display values, by curves that do not depend on the image; see krawczyk.comp.
#extension GL_GOOGLE_include_directive : require
#include "shade/srgb.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) readonly uniform image2DArray radiance;
layout(set = 0, binding = 1, rgba8) writeonly uniform image2DArray display;
layout(constant_id = 0) const bool kSwapRedBlue = false;
layout(push_constant) uniform Push {
    float scale;
    uint curve;  // pellucid::ToneMap
};

// Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002, equation 3, on luminance.
vec3 reinhard(vec3 c) {
    return c / (1.0 + dot(c, vec3(0.2126, 0.7152, 0.0722)));
}

// Narkowicz, "ACES Filmic Tone Mapping Curve", 2015.
vec3 aces(vec3 c) {
    return (c * (2.51 * c + 0.03)) / (c * (2.43 * c + 0.59) + 0.14);
}

// Khronos PBR Neutral Tone Mapper, specification 1.0 (2024): subtracts a small offset for the surface's reflection of
// white, then compresses values above 0.8 towards a desaturated 1.
vec3 neutral(vec3 c) {
    const float start = 0.8 - 0.04, desaturation = 0.15;
    float low = min(c.r, min(c.g, c.b));
    c -= low < 0.08 ? low - 6.25 * low * low : 0.04;
    float peak = max(c.r, max(c.g, c.b));
    if (peak < start) return c;
    const float d = 1.0 - start;
    float compressed = 1.0 - d * d / (peak + d - start);
    float white = 1.0 / (desaturation * (peak - compressed) + 1.0);
    return mix(vec3(compressed), c * (compressed / peak), white);
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID.xy, 0);
    if (any(greaterThanEqual(at.xy, imageSize(radiance).xy))) return;
    vec3 c = max(scale * imageLoad(radiance, at).rgb, vec3(0.0));
    c = min(c, vec3(1e6));  // the curves square it
    if (curve == 1u) c = reinhard(c);
    else if (curve == 2u) c = aces(c);
    else if (curve == 3u) c = neutral(c);
    c = srgb_from_linear(clamp(c, 0.0, 1.0));
    imageStore(display, at, vec4(kSwapRedBlue ? c.bgr : c, 1.0));
}
