#version 460
// Lists triangles in the texels of the tiles into which rasterise_surfaces.comp has cut them.
#extension GL_GOOGLE_include_directive : require
#include "layers/map_triangle_setup.glsl"
#include "layers/map_records.glsl"
#define PELLUCID_READS_TILES
#include "layers/triangle_tiles.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) readonly buffer Maps { MapRecord maps[]; };
layout(std430, set = 0, binding = 4) readonly buffer MapTriangles { vec4 map_triangles[]; };
layout(push_constant) uniform Push { uint map_index; };

void main() {
    uint group = gl_WorkGroupID.x * gl_NumWorkGroups.y + gl_WorkGroupID.y;
    uint i = group * 64u + gl_LocalInvocationID.x;
    if (i >= min(tile_count, tiles.length())) return;
    MapRecord map = maps[map_index];
    uint triangle = tiles[i].x;
    ivec2 first = tile_corner(i);
    vec3 corner = map_triangles[3u * triangle].xyz;
    vec4 p[3] = vec4[3](map.map_from_space * vec4(corner, 1.0),
                        map.map_from_space * vec4(corner + map_triangles[3u * triangle + 1u].xyz, 1.0),
                        map.map_from_space * vec4(corner + map_triangles[3u * triangle + 2u].xyz, 1.0));
    MapCoverage c = cover(map, p);
    ivec2 low = max(first, c.low), high = min(first + kTile - 1, c.high);
    for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
            if (covers(c, ivec2(x, y))) {
                put_record(map, atomicAdd(found_count, 1u), ivec2(x, y), triangle, depths_in_texel(c, ivec2(x, y)), true);
            }
        }
    }
}
