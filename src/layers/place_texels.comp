#version 460
// Makes room for the records of each texel: blocks of texels lie together, as rays pass through them.
#extension GL_GOOGLE_include_directive : require
#include "layers/surface_map.glsl"
#include "layers/map_count.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, set = 0, binding = 2) readonly buffer Maps { MapRecord maps[]; };
layout(std430, set = 0, binding = 6) buffer Texels { TexelRecords texels[]; };

const int kBlock = 4;  // texels along a side

void main() {
    MapRecord map = maps[0];
    ivec2 low = kBlock * ivec2(gl_GlobalInvocationID.xy), high = min(low + kBlock, ivec2(map.width, map.height));
    if (low.x >= int(map.width) || low.y >= int(map.height)) return;
    uint sum = 0u;
    for (int y = low.y; y < high.y; ++y) {
        for (int x = low.x; x < high.x; ++x) sum += texels[int(map.first_head) + y * int(map.width) + x].count;
    }
    if (sum == 0u) return;
    uint first = atomicAdd(counts.placed, sum);
    for (int y = low.y; y < high.y; ++y) {
        for (int x = low.x; x < high.x; ++x) {
            int i = int(map.first_head) + y * int(map.width) + x;
            texels[i].first = first;
            first += texels[i].count;
        }
    }
}
