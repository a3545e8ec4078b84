#version 460
// Copies the pixels that a technique has shaded itself (Refraction::picture) into the frame.
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool kAnalysis = false;  // View::kAnalysis

layout(set = 0, binding = 0, rgba32f) readonly uniform image2DArray picture;
layout(set = 0, binding = 1, r32ui) readonly uniform uimage2DArray path_events;
layout(set = 0, binding = 2, rgba32f) readonly uniform image2DArray reflected_radiance;
layout(set = 0, binding = 3, rgba32f) writeonly uniform image2DArray radiance;

#include "shade/analysis_color.glsl"

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID.xy, 0);
    if (any(greaterThanEqual(at.xy, imageSize(picture).xy))) return;
    vec4 own = imageLoad(picture, at);
    if (own.a < 0.5) return;
    imageStore(radiance, at, vec4(kAnalysis ? analysis_color(imageLoad(path_events, at).r) : own.rgb + imageLoad(reflected_radiance, at).rgb, 1.0));
}
