#version 460
// Radiance of every pixel without refracting glass. shade.comp then overwrites the pixels with glass.
#extension GL_GOOGLE_include_directive : require
#include "shade/shade_bindings.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 3) const bool kOpaque = false;  // the scene has opaque objects

layout(set = 0, binding = 5, rgba32f) readonly uniform image2DArray opaque_radiance;
layout(set = 0, binding = 6, r32f) readonly uniform image2DArray opaque_depth;

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID.xy, 0);
    if (at.x >= int(frame.width) || at.y >= int(frame.height)) return;
    if (kAnalysis) {
        store_radiance(at.xy, vec3(0.02));
        return;
    }
    vec3 seen = drawn(PELLUCID_EMITTED, radiance_from_afar(world_view_direction(at.xy)));
    float opaque = kOpaque ? imageLoad(opaque_depth, at).r : PELLUCID_EMPTY_DEPTH;
    if (kBackground && stored_depth(at.xy) == PELLUCID_EMPTY_DEPTH) seen = background_at(at.xy);
    if (opaque < PELLUCID_EMPTY_DEPTH) seen = imageLoad(opaque_radiance, at).rgb;
    see_lamps(at.xy, opaque, seen);
    store_radiance(at.xy, seen);
}
