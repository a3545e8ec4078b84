#version 460
// Allocates the records of each texel. Blocks of texels lie together, because a ray passes through neighbours.
#extension GL_GOOGLE_include_directive : require
#include "layers/surface_map.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) readonly buffer Maps { MapRecord maps[]; };
layout(std430, set = 0, binding = 6) buffer Texels { TexelRecords texels[]; };
layout(std430, set = 0, binding = 7) buffer Found { uint found_count, placed; };
layout(push_constant) uniform Push {
    uint map_index;
    uint first_record;  // of the map
};

const int kBlock = 16;  // texels

uint whole_blocks(uint records) { return (records + kRangeBlock - 1u) / kRangeBlock * kRangeBlock; }

void main() {
    MapRecord map = maps[map_index];
    int low = kBlock * int(gl_GlobalInvocationID.x), count = 1 << (map.log2_width + map.log2_height);
    if (low >= count) return;
    int high = int(map.first_head) + min(low + kBlock, count);
    low += int(map.first_head);
    uint sum = 0u;
    for (int i = low; i < high; ++i) sum += whole_blocks(texels[i].count);
    if (sum == 0u) return;
    uint first = first_record + atomicAdd(placed, sum);
    for (int i = low; i < high; ++i) {
        texels[i].first = first;
        first += whole_blocks(texels[i].count);
    }
}
