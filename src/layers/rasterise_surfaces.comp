#version 460
// Lists every triangle of the scene, or of one mesh in its own frame, in the texels of a map: small ones here; large
// ones are cut into tiles for rasterise_tiles.comp.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
#include "gpu/vertices.glsl"
#include "layers/map_triangle_setup.glsl"
#include "layers/map_records.glsl"
#include "layers/objects.glsl"
#include "layers/triangle_tiles.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) readonly buffer Maps { MapRecord maps[]; };
layout(std430, set = 0, binding = 4) writeonly buffer MapTriangles { vec4 map_triangles[]; };
layout(std430, set = 0, binding = 10) writeonly buffer MapNormals { vec4 map_normals[]; };
layout(constant_id = 0) const bool kOfMesh = false;
layout(constant_id = 1) const bool kOneObject = false;
layout(push_constant) uniform Push {
    uint triangle_count;
    uint map_index;
    uint row;  // invocations in a row of the dispatch
};

const int kSmall = 2 * kTile * kTile;  // texels of a box that one invocation goes through

void main() {
    uint number = gl_GlobalInvocationID.y * row + gl_GlobalInvocationID.x;
    if (number >= triangle_count) return;
    MapRecord map = maps[map_index];
    uint triangle = map.first_triangle + number, corner = 3u * triangle;
    mat4 space_from_object = mat4(1.0);
    mat3 normals_from_object = mat3(1.0);
    bool mirrored = false;
    if (!kOfMesh) {
        uint object = kOneObject ? 0u : find_object(triangle);
        corner = objects[object].first_corner + 3u * (triangle - objects[object].first_triangle);
        space_from_object = objects[object].world_from_object;
        normals_from_object = mat3(objects[object].world_from_object_normal);
        mirrored = objects[object].mirrored != 0u;
    }
    uvec3 corners = uvec3(indices[corner], indices[corner + 1u], indices[corner + 2u]);
    if (mirrored) corners.yz = corners.zy;
    vec3 v[3];
    for (int i = 0; i < 3; ++i) {
        v[i] = (space_from_object * vec4(vertex_position(corners[i]), 1.0)).xyz;
    }
    map_triangles[3u * triangle] = vec4(v[0], 0.0);
    map_triangles[3u * triangle + 1u] = vec4(v[1] - v[0], 0.0);
    map_triangles[3u * triangle + 2u] = vec4(v[2] - v[0], 0.0);
    for (int i = 0; i < 3; ++i) map_normals[3u * triangle + i] = vec4(normals_from_object * vertex_normal(corners[i]), 0.0);

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
