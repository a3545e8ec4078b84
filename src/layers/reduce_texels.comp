#version 460
// A coarser level of a map's pyramid from the one below it.
#extension GL_GOOGLE_include_directive : require
#include "layers/surface_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, set = 0, binding = 2) readonly buffer Maps { MapRecord maps[]; };
layout(std430, set = 0, binding = 9) buffer Pyramid { uvec4 pyramid[]; };
layout(push_constant) uniform Push { uint level; };

void main() {
    MapRecord map = maps[0];
    uvec2 cell = gl_GlobalInvocationID.xy;
    if (cell.x >= 1u << (map.log2_width - level) || cell.y >= 1u << (map.log2_height - level)) return;
    uvec4 ranges = uvec4(kNoRange);
    int order = texel_order(map, ivec2(cell << level));
    for (int child = 0; child < 4; ++child) {
        uvec4 below = pyramid[node_index(map, int(level) - 1, order) + child];
        for (int i = 0; i < 4; ++i) insert_range(ranges, below[i]);
    }
    pyramid[node_index(map, int(level), order)] = ranges;
}
