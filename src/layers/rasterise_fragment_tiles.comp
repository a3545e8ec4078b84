#version 460
// Rasterises the tiles into which rasterise_fragments.comp has cut triangles.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
#include "layers/objects.glsl"
#include "layers/triangle_fragments.glsl"
#define PELLUCID_READS_TILES
#include "layers/triangle_tiles.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Push { uint first_row, row_end; };

void main() {
    uint group = gl_WorkGroupID.x * gl_NumWorkGroups.y + gl_WorkGroupID.y;
    uint i = group * 64u + gl_LocalInvocationID.x;
    if (i >= min(tile_count, tiles.length())) return;
    uint triangle = tiles[i].x;
    ObjectRecord object = objects[find_object(triangle)];
    PlacedMesh mesh =
        PlacedMesh(object.world_from_object, object.first_triangle, object.first_corner, object.mirrored, 0u);
    ScreenTriangle t = screen_triangle(mesh, triangle, ivec2(0, first_row), ivec2(frame.width, row_end));
    ivec2 first = tile_corner(i);
    ivec2 low = max(first, t.low), high = min(first + kTile - 1, t.high);
    for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
            float depth;
            bool covered = t.crosses_near ? met_at(t, ivec2(x, y), depth) : covered_at(t, ivec2(x, y), depth);
            if (covered) append_fragment(ivec2(x, y), Fragment(depth, t.record));
        }
    }
}
