#version 460
// Wang 2014, section 3.5.2: where layer k is empty, layer k - 2 replaces it. A ray that leaves through the silhouette
// of a deeper layer then still finds a surface.
#extension GL_GOOGLE_include_directive : require
#include "gpu/structs.h"

#include "layers/pixel_list.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

layout(set = 0, binding = 0, r32f) readonly uniform image2DArray layer_depth;
layout(set = 0, binding = 1, r32f) writeonly uniform image2DArray merged_depth;
layout(set = 0, binding = 2, r32ui) readonly uniform uimage2DArray layer_normal;
layout(set = 0, binding = 3, r32ui) writeonly uniform uimage2DArray merged_normal;
// depth >= 0, so its bits compare as integers
layout(std430, set = 0, binding = 4) buffer EntryLimit { uint farthest_entry; };
layout(push_constant) uniform Push { uint layer_count; };

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;

    // Index 0: entries; index 1: exits.
    float last_of_kind[2] = float[2](PELLUCID_EMPTY_DEPTH, -PELLUCID_EMPTY_DEPTH);
    uint normal_of_kind[2] = uint[2](0u, 0u);
    for (uint layer = 0u; layer < layer_count; ++layer) {
        float depth = imageLoad(layer_depth, ivec3(texel, layer)).r;
        if (depth != PELLUCID_EMPTY_DEPTH) {
            last_of_kind[layer & 1u] = depth;
            normal_of_kind[layer & 1u] = imageLoad(layer_normal, ivec3(texel, layer)).r;
        }
        imageStore(merged_depth, ivec3(texel, layer), vec4(last_of_kind[layer & 1u]));
        imageStore(merged_normal, ivec3(texel, layer), uvec4(normal_of_kind[layer & 1u]));
    }
    if (last_of_kind[0] < PELLUCID_EMPTY_DEPTH) atomicMax(farthest_entry, floatBitsToUint(max(last_of_kind[0], 0.0)));
}
