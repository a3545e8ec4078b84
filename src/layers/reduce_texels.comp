#version 460
// Reduces a level of a map's pyramid to the next coarser level.
#extension GL_GOOGLE_include_directive : require
#include "layers/surface_map.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) readonly buffer Maps { MapRecord maps[]; };
layout(std430, set = 0, binding = 9) buffer Pyramid { uvec4 pyramid[]; };
layout(push_constant) uniform Push {
    uint map_index;
    uint level;
};

void main() {
    MapRecord map = maps[map_index];
    int node = int(gl_GlobalInvocationID.x);
    if (node >= 1 << (map.log2_width + map.log2_height - 2u * level)) return;
    int below = level_start(map, int(level) - 1) + 4 * node;
    uvec4 ranges = uvec4(kNoRange);
    for (int child = 0; child < 4; ++child) {
        uvec4 own = pyramid[below + child];
        for (int i = 0; i < 4; ++i) insert_range(ranges, own[i]);
    }
    pyramid[level_start(map, int(level)) + node] = ranges;
}
