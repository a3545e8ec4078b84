#version 460
// Lists every triangle of the scene, or of one mesh in its own frame, in the texels of a map. Cuts large triangles into
// tiles for rasterise_tiles.comp.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
#include "gpu/vertices.glsl"
#include "layers/map_triangle_setup.glsl"
#include "layers/map_records.glsl"
#include "layers/objects.glsl"
#include "layers/place_triangle.glsl"
#include "layers/triangle_tiles.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) readonly buffer Maps { MapRecord maps[]; };
layout(constant_id = 0) const bool kOfMesh = false;
layout(constant_id = 1) const bool kOneObject = false;
layout(push_constant) uniform Push {
    uint triangle_count;
    uint map_index;
    uint row;  // invocations in a row of the dispatch
};

const int kSmall = 2 * kTile * kTile;  // most texels of a box that one invocation processes

void main() {
    uint number = gl_GlobalInvocationID.y * row + gl_GlobalInvocationID.x;
    if (number >= triangle_count) return;
    MapRecord map = maps[map_index];
    uint triangle = map.first_triangle + number;
    vec3 v[3];
    if (kOfMesh) place_triangle(triangle, 3u * triangle, mat4(1.0), mat3(1.0), false, v);
    else place_in_world(triangle, kOneObject ? 0u : find_object(triangle), v);

    vec4 p[3];
    for (int i = 0; i < 3; ++i) p[i] = map.map_from_space * vec4(v[i], 1.0);
    MapCoverage c = cover(map, p);
    ivec2 size = c.high - c.low + 1;
    if (size.x <= 0 || size.y <= 0) return;
    if (size.x * size.y <= kSmall) {
        uint at = atomicAdd(found_count, uint(size.x * size.y)), end = at + uint(size.x * size.y);
        ivec2 texel = c.low;
        for (; at < end; ++at) {
            put_record(map, at, texel, triangle, depths_in_texel(c, texel), covers(c, texel));
            bool turn = texel.x == c.high.x;
            texel = ivec2(turn ? c.low.x : texel.x + 1, turn ? texel.y + 1 : texel.y);
        }
        return;
    }
    cut_into_tiles(triangle, c.low, c.high);
}
