#version 460
// Computes the normals of layers whose depths and triangles are known.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
#include "gpu/vertices.glsl"
#include "layers/layers.glsl"
#include "layers/pixel_list.glsl"
#include "layers/surface_normal.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

layout(set = 0, binding = 2, r32ui) readonly uniform uimage2DArray layer_triangle;
layout(set = 0, binding = 3, r32ui) writeonly uniform uimage2DArray layer_normal;
// With one object all pixels share its record, and some drivers then read the record only once.
layout(constant_id = 0) const bool kOneObject = false;
layout(push_constant) uniform Push {
    uint layer_count;
    uint only_object;
};

#include "layers/objects.glsl"

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    uint object = only_object;
    Ray ray = object_ray(vec2(texel) + 0.5, object);
    for (uint layer = 0u; layer < layer_count; ++layer) {
        uint triangle = imageLoad(layer_triangle, ivec3(texel, layer)).r;
        if (triangle == PELLUCID_NO_TRIANGLE) return;
        if (!kOneObject) {
            object = find_object(triangle_index(triangle));
            ray = object_ray(vec2(texel) + 0.5, object);
        }
        imageStore(layer_normal, ivec3(texel, layer), uvec4(surface_normal(ray, triangle, object)));
    }
}
