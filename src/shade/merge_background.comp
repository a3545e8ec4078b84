#version 460
// Merges the caller's background into the opaque surfaces, where it lies in front of them.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gpu/frame.glsl"
#include "gpu/background.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, rgba32f) writeonly uniform image2DArray opaque_radiance;
layout(set = 0, binding = 2, r32f) uniform image2DArray opaque_depth;
layout(set = 0, binding = 3, r32ui) writeonly uniform uimage2DArray opaque_object;
layout(set = 0, binding = 4, r32ui) writeonly uniform uimage2DArray opaque_triangle;

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID.xy, 0);
    if (at.x >= int(frame.width) || at.y >= int(frame.height)) return;
    float depth = stored_depth(at.xy);
    if (depth == PELLUCID_EMPTY_DEPTH || depth >= imageLoad(opaque_depth, at).r) return;
    imageStore(opaque_radiance, at, vec4(background_at(at.xy), 1.0));
    imageStore(opaque_depth, at, vec4(depth, 0.0, 0.0, 0.0));
    imageStore(opaque_object, at, uvec4(frame.object_count));
    imageStore(opaque_triangle, at, uvec4(PELLUCID_NO_TRIANGLE));
}
