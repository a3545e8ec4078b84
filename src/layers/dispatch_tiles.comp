#version 460
// How many workgroups rasterise_tiles.comp needs.
#extension GL_GOOGLE_include_directive : require
#include "layers/map_count.glsl"

layout(local_size_x = 1) in;
layout(push_constant) uniform Push {
    uint tile_capacity;
    uint row;  // workgroups that fit in a row of a dispatch
};

void main() {
    uint groups = (min(counts.tiles, tile_capacity) + 63u) / 64u;
    counts.tile_rows = groups / row + 1u;
    counts.tile_groups = (groups + counts.tile_rows - 1u) / counts.tile_rows;
    counts.tile_layers = 1u;
}
