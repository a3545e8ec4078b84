#version 460
// How many workgroups go through the tiles of large triangles, and through the records.
#extension GL_GOOGLE_include_directive : require
#include "layers/map_count.glsl"

layout(local_size_x = 1) in;
layout(std430, set = 0, binding = 6) writeonly buffer Groups { uint groups[3]; };
layout(push_constant) uniform Push {
    uint of_records;  // 0: of tiles
    uint capacity;
    uint row;  // workgroups that fit in a row of a dispatch
};

void main() {
    uint needed = (min(of_records != 0u ? counts.records : counts.tiles, capacity) + 63u) / 64u;
    uint rows = needed / row + 1u;
    groups[0] = (needed + rows - 1u) / rows;
    groups[1] = rows;
    groups[2] = 1u;
}
