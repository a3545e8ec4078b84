#version 460
// Layers from a surface map: of the surfaces that the view ray through a pixel's centre meets, the nearest in order.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
#include "gpu/vertices.glsl"
#include "gpu/object_traits.glsl"
#include "layers/layers.glsl"
#include "layers/objects.glsl"
#include "layers/pixel_list.glsl"
#include "layers/surface_map.glsl"
#include "layers/surface_normal.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

layout(set = 0, binding = 2) uniform utextureBuffer map_triangles;
layout(set = 0, binding = 3) uniform utextureBuffer records;
layout(set = 0, binding = 6) uniform utextureBuffer texels;
layout(std430, set = 0, binding = 9) readonly buffer Maps { MapRecord maps[]; };
layout(set = 0, binding = 4, r32f) readonly uniform image2DArray opaque_depth;
layout(set = 0, binding = 5, r32f) writeonly uniform image2DArray layer_depth;
layout(set = 0, binding = 7, r32ui) writeonly uniform uimage2DArray layer_triangle;
layout(set = 0, binding = 8, r32ui) writeonly uniform uimage2DArray layer_normal;
layout(push_constant) uniform Push {
    uint layer_count;
    uint hidden_by_opaque;
    uint first_triangle, end_triangle;  // of the objects that are asked for
    float texels_per_pixel;
};

const float kDepthRounding = 5e-5;  // of rasterised depths, relative
const float kSlack = 1e-4;  // of barycentric weights, as in surface_walk.glsl

Fragment nearest_behind(uvec2 own, vec3 origin, vec3 direction, float depth_rate, Fragment last, bool any) {
    Fragment nearest = kNoFragment;
    for (uint i = 0u; i < own.y; ++i) {
        uvec4 record = texelFetch(records, int(own.x + i));
        if (!refractive(record.z)) continue;
        uint triangle = record.y;
        if (triangle < first_triangle || triangle >= end_triangle) continue;
        int at = 3 * int(triangle);
        vec4 a = uintBitsToFloat(texelFetch(map_triangles, at)), b = uintBitsToFloat(texelFetch(map_triangles, at + 1)),
             c = uintBitsToFloat(texelFetch(map_triangles, at + 2));
        vec3 p = cross(direction, c.xyz), from_corner = origin - a.xyz, q = cross(from_corner, b.xyz);
        float determinant = dot(b.xyz, p);
        vec2 weights = vec2(dot(from_corner, p), dot(direction, q)) / determinant;
        float depth = dot(c.xyz, q) / determinant * depth_rate;
        if (!(min(min(weights.x, weights.y), 1.0 - weights.x - weights.y) >= -kSlack && depth > frame.near_plane)) continue;
        Fragment entry = Fragment(depth, triangle | (determinant < 0.0 ? PELLUCID_BACK_FACE : 0u));
        if ((any || is_behind(entry, last)) && is_behind(nearest, entry)) nearest = entry;
    }
    return nearest;
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    Ray view = camera_ray(vec2(texel) + 0.5);
    vec3 origin = (frame.world_from_view * vec4(view.origin, 1.0)).xyz;
    vec3 direction = mat3(frame.world_from_view) * view.direction;
    uvec2 own = texelFetch(texels, texel_order(maps[0], ivec2((vec2(texel) + 0.5) * texels_per_pixel))).xy;
    Fragment fragment = kNoFragment;
    for (uint layer = 0u; layer < layer_count; ++layer) {
        fragment = nearest_behind(own, origin, direction, -view.direction.z, fragment, layer == 0u);
        if (fragment.triangle == PELLUCID_NO_TRIANGLE) return;
        if (layer == 0u && hidden_by_opaque != 0u) {
            float opaque = imageLoad(opaque_depth, ivec3(texel, 0)).r;
            if (fragment.depth >= opaque - kDepthRounding * opaque) return;
        }
        imageStore(layer_depth, ivec3(texel, layer), vec4(fragment.depth));
        imageStore(layer_triangle, ivec3(texel, layer), uvec4(fragment.triangle));
        uint object = find_object(triangle_index(fragment.triangle));
        Ray ray = object_ray(vec2(texel) + 0.5, object);
        imageStore(layer_normal, ivec3(texel, layer), uvec4(surface_normal(ray, fragment.triangle, object)));
    }
}
