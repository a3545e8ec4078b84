#version 460
// Writes the nearest fragments of each pixel's list in order. Selection reads the list once per layer and needs no
// memory of its own. So a list may have any length, and a pixel any number of layers.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
#include "gpu/vertices.glsl"
#include "layers/fragment_list.glsl"
#include "layers/pixel_list.glsl"
#include "layers/surface_normal.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

layout(std430, set = 0, binding = 2) readonly buffer Nodes { uint node_count, nodes_reserved[3]; Node nodes[]; };
layout(set = 0, binding = 3, r32ui) readonly uniform uimage2DArray heads;
layout(set = 0, binding = 4, r32f) readonly uniform image2DArray opaque_depth;
layout(set = 0, binding = 5, r32f) writeonly uniform image2DArray layer_depth;
layout(set = 0, binding = 6, r32ui) writeonly uniform uimage2DArray layer_triangle;
layout(set = 0, binding = 7, r32ui) writeonly uniform uimage2DArray layer_normal;
// With one object all pixels share its record, and some drivers then read the record only once.
layout(constant_id = 0) const bool kOneObject = false;
layout(push_constant) uniform Push {
    uint layer_count;
    uint hidden_by_opaque;
    uint only_object;
    float depth_rounding;  // relative difference between opaque depths and fragment depths of one surface
};

#include "layers/objects.glsl"

Fragment nearest_behind(uint head, Fragment last, bool any) {
    Fragment nearest = kNoFragment;
    for (uint node = head; node != 0u;) {
        Node entry = nodes[node - 1u];
        if ((any || is_behind(entry.fragment, last)) && is_behind(nearest, entry.fragment)) nearest = entry.fragment;
        node = entry.next;
    }
    return nearest;
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;

    uint head = imageLoad(heads, ivec3(texel, 0)).r;
    Fragment fragment = kNoFragment;
    uint object = only_object;
    Ray ray = object_ray(vec2(texel) + 0.5, object);
    for (uint layer = 0u; layer < layer_count; ++layer) {
        fragment = nearest_behind(head, fragment, layer == 0u);
        if (fragment.triangle == PELLUCID_NO_TRIANGLE) return;
        if (layer == 0u && hidden_by_opaque != 0u) {
            float opaque = imageLoad(opaque_depth, ivec3(texel, 0)).r;
            if (fragment.depth >= opaque - depth_rounding * opaque) return;
        }
        imageStore(layer_depth, ivec3(texel, layer), vec4(fragment.depth));
        imageStore(layer_triangle, ivec3(texel, layer), uvec4(fragment.triangle));
        if (!kOneObject) {
            object = find_object(triangle_index(fragment.triangle));
            ray = object_ray(vec2(texel) + 0.5, object);
        }
        imageStore(layer_normal, ivec3(texel, layer), uvec4(surface_normal(ray, fragment.triangle, object)));
    }
}
