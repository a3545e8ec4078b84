#version 460
// Lists every triangle of the scene in the texels of a map: small ones here; large ones are cut into tiles for
// rasterise_tiles.comp, so that no invocation has much more to do than its neighbours.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
#include "gpu/vertices.glsl"
#include "layers/map_triangle_setup.glsl"
#include "layers/map_records.glsl"
#include "layers/objects.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) readonly buffer Maps { MapRecord maps[]; };
layout(std430, set = 0, binding = 3) readonly buffer Neighbors { uvec2 neighbors[]; };  // per corner: Neighbor
layout(std430, set = 0, binding = 4) writeonly buffer MapTriangles { vec4 map_triangles[]; };
layout(std430, set = 0, binding = 8) writeonly buffer Tiles { uvec2 tiles[]; };  // triangle, tile's x | y << 16
layout(push_constant) uniform Push {
    uint triangle_count;
    uint record_capacity;
    uint tile_capacity;
    uint row;  // invocations in a row of the dispatch
    float steep;   // cosine between a triangle's normal and the map's rays below which it is steep
    float crease;  // cosine between neighbours' normals below which their edge is a crease
};

const int kTile = 8;              // texels along a side
const int kSmall = 2 * kTile * kTile;  // texels of a box that one invocation goes through

// Whether the neighbour across an edge goes on much as the triangle does.
bool continued(vec3 normal, vec3 a, vec3 b, uvec2 neighbor, mat4 space_from_object) {
    if (neighbor.x == PELLUCID_NO_TRIANGLE) return false;
    vec3 opposite = (space_from_object * vec4(vertex_position(neighbor.y), 1.0)).xyz;
    vec3 other = cross(a - b, opposite - b);  // runs along the edge the other way
    return dot(normal, other) > crease * sqrt(dot(normal, normal) * dot(other, other));
}

void main() {
    uint triangle = gl_GlobalInvocationID.y * row + gl_GlobalInvocationID.x;
    if (triangle >= triangle_count) return;
    MapRecord map = maps[0];
    uint object = find_object(triangle);
    uint first = objects[object].first_triangle;
    uint corner = objects[object].first_corner + 3u * (triangle - first);
    mat4 space_from_object = objects[object].world_from_object;
    vec3 v[3];
    for (int i = 0; i < 3; ++i) {
        v[i] = (space_from_object * vec4(vertex_position(indices[corner + i]), 1.0)).xyz;
    }
    uvec2 across[3] = uvec2[3](neighbors[corner], neighbors[corner + 1u], neighbors[corner + 2u]);

    vec3 normal = cross(v[1] - v[0], v[2] - v[0]);
    vec3 ray = map.eye.w * v[0] - map.eye.xyz;
    bool continues = abs(dot(normal, ray)) > steep * sqrt(dot(normal, normal) * dot(ray, ray));
    for (int i = 0; i < 3; ++i) continues = continues && continued(normal, v[i], v[(i + 1) % 3], across[i], space_from_object);

    uvec3 beyond = uvec3(across[0].x, across[1].x, across[2].x);
    for (int i = 0; i < 3; ++i) beyond[i] = beyond[i] == PELLUCID_NO_TRIANGLE ? beyond[i] : beyond[i] + first;
    map_triangles[3u * triangle] = vec4(v[0], uintBitsToFloat(beyond.x));
    map_triangles[3u * triangle + 1u] = vec4(v[1] - v[0], uintBitsToFloat(beyond.y));
    map_triangles[3u * triangle + 2u] = vec4(v[2] - v[0], uintBitsToFloat(beyond.z));

    vec4 p[3];
    for (int i = 0; i < 3; ++i) p[i] = map.map_from_space * vec4(v[i], 1.0);
    MapCoverage c = cover(map, p);
    ivec2 size = c.high - c.low + 1;
    uint word = triangle | (continues ? kContinues : 0u);
    if (size.x <= 0 || size.y <= 0) return;
    if (size.x * size.y <= kSmall) {
        for (int i = 0; i < size.x * size.y; ++i) {
            ivec2 texel = c.low + ivec2(i % size.x, i / size.x);
            if (covers(c, texel, !continues)) {
                append_record(map, texel, word, depths_in_texel(c, texel, continues), record_capacity);
            }
        }
        return;
    }
    ivec2 first_tile = c.low / kTile, tile_count = c.high / kTile - first_tile + 1;
    uint at = atomicAdd(counts.tiles, uint(tile_count.x * tile_count.y));
    for (int i = 0; i < tile_count.x * tile_count.y; ++i) {
        ivec2 tile = first_tile + ivec2(i % tile_count.x, i / tile_count.x);
        if (at + uint(i) < tile_capacity) tiles[at + uint(i)] = uvec2(word, uint(tile.x) | uint(tile.y) << 16);
    }
}
