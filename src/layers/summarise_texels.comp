#version 460
// Computes the finest level of a map's pyramid from the depth ranges of each texel's records.
#extension GL_GOOGLE_include_directive : require
#include "layers/surface_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, set = 0, binding = 2) readonly buffer Maps { MapRecord maps[]; };
layout(set = 0, binding = 6) uniform utextureBuffer texels;
layout(set = 0, binding = 7) uniform utextureBuffer ranges;
layout(std430, set = 0, binding = 9) writeonly buffer Pyramid { uvec4 pyramid[]; };
layout(push_constant) uniform Push { uint map_index; };

void main() {
    MapRecord map = maps[map_index];
    uvec2 texel = gl_GlobalInvocationID.xy;
    if (texel.x >= 1u << map.log2_width || texel.y >= 1u << map.log2_height) return;
    uvec4 node = uvec4(kNoRange);
    int order = texel_order(map, ivec2(texel));
    if (texel.x < map.width && texel.y < map.height) {
        uvec2 own = texelFetch(texels, int(map.first_head) + order).xy;
        for (uint i = 0u; i < own.y; i += kRangeBlock) {
            uvec4 block = texelFetch(ranges, int((own.x + i) / kRangeBlock));
            for (uint k = 0u; k < kRangeBlock; ++k) insert_range(node, block[k]);
        }
    }
    pyramid[node_index(map, 0, order)] = node;
}
