#ifndef PELLUCID_TECHNIQUES_WYMAN_2005_BAKED_DISTANCES_GLSL
#define PELLUCID_TECHNIQUES_WYMAN_2005_BAKED_DISTANCES_GLSL

// Baked distances through solids; see baked_distances.h. Needs: objects (ObjectRecord[]), gpu/vertices.glsl,
// layers/surface_normal.glsl.

struct BakedObject {
    mat4 baked_from_world;
    vec4 center;  // centre of the table's directions, baked frame; w: metres in world space per baked unit
    uint first_value;
    uint reserved0, reserved1, reserved2;
};
layout(std430, set = 0, binding = 12) readonly buffer BakedObjects { BakedObject baked_objects[]; };
layout(std430, set = 0, binding = 13) readonly buffer Distances { float distances[]; };

// d_N: distance through the solid against the normal, metres in world space.
float inward_distance(SurfacePoint at, uint object) {
    BakedObject baked = baked_objects[object];
    vec3 of_corners = vec3(distances[baked.first_value + at.corners.x], distances[baked.first_value + at.corners.y],
                           distances[baked.first_value + at.corners.z]);
    return dot(at.weights, of_corners) * baked.center.w;
}

// Four texels of an octahedral map and their bilinear weights.
struct MapTexels {
    uint texels[4];
    float weights[4];
};

// Texels beyond an edge of the map wrap to the same edge, mirrored about its middle.
uint map_texel(ivec2 texel, int side) {
    if (texel.x < 0 || texel.x >= side) texel = ivec2(clamp(texel.x, 0, side - 1), side - 1 - texel.y);
    if (texel.y < 0 || texel.y >= side) texel = ivec2(side - 1 - texel.x, clamp(texel.y, 0, side - 1));
    return uint(texel.y * side + texel.x);
}

MapTexels map_texels(vec3 direction, int side) {
    vec2 p = direction.xy / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    if (direction.z < 0.0) p = (1.0 - abs(p.yx)) * sign_not_zero(p);
    vec2 at = (0.5 * p + 0.5) * float(side) - 0.5;
    ivec2 low = ivec2(floor(at));
    vec2 share = at - vec2(low), rest = 1.0 - share;
    return MapTexels(uint[4](map_texel(low, side), map_texel(low + ivec2(1, 0), side),
                             map_texel(low + ivec2(0, 1), side), map_texel(low + ivec2(1, 1), side)),
                     float[4](rest.x * rest.y, share.x * rest.y, rest.x * share.y, share.x * share.y));
}

// The table's distance through the solid from a surface point, in world space; negative: no value there.
float sampled_distance(uint object, vec3 position, vec3 direction, uint side) {
    BakedObject baked = baked_objects[object];
    vec3 outwards = (baked.baked_from_world * vec4(position, 1.0)).xyz - baked.center.xyz;
    if (dot(outwards, outwards) == 0.0) outwards.z = 1.0;
    MapTexels points = map_texels(outwards, int(side));
    MapTexels directions = map_texels(mat3(baked.baked_from_world) * direction, int(side));
    float sum = 0.0, weight = 0.0;
    for (int p = 0; p < 4; ++p) {
        for (int d = 0; d < 4; ++d) {
            float value = distances[baked.first_value + points.texels[p] * side * side + directions.texels[d]];
            float share = value < 0.0 ? 0.0 : points.weights[p] * directions.weights[d];
            sum += share * value;
            weight += share;
        }
    }
    return weight > 0.0 ? sum / weight * baked.center.w : -1.0;
}

#endif
