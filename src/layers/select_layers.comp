#version 460
// Writes the nearest fragments of each pixel's list in order. Selection reads the list once per
// layer; it needs no memory of its own, so neither lists nor layers have a maximum length.
#extension GL_GOOGLE_include_directive : require
#include "layers/fragment_list.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, set = 0, binding = 0) readonly buffer Nodes { Node nodes[]; };
layout(set = 0, binding = 1, r32ui) readonly uniform uimage2DArray heads;
layout(set = 0, binding = 2, r32f) readonly uniform image2DArray opaque_depth;
layout(set = 0, binding = 3, r32f) writeonly uniform image2DArray layer_depth;
layout(set = 0, binding = 4, rg32ui) writeonly uniform uimage2DArray layer_surface;
layout(push_constant) uniform Push {
    uint first_row;
    uint row_end;
    uint layer_count;
};

const Fragment kNone = Fragment(PELLUCID_EMPTY_DEPTH, 0u, PELLUCID_NO_TRIANGLE);

Fragment nearest_behind(uint head, Fragment last, bool any) {
    Fragment nearest = kNone;
    for (uint node = head; node != 0u;) {
        Node entry = nodes[node - 1u];
        if ((any || is_behind(entry.fragment, last)) && is_behind(nearest, entry.fragment)) nearest = entry.fragment;
        node = entry.next;
    }
    return nearest;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, first_row);
    if (texel.x >= imageSize(layer_depth).x || texel.y >= int(row_end)) return;

    uint head = imageLoad(heads, ivec3(texel, 0)).r;
    Fragment fragment = kNone;
    for (uint layer = 0u; layer < layer_count; ++layer) {
        fragment = nearest_behind(head, fragment, layer == 0u);
        if (layer == 0u && fragment.depth >= imageLoad(opaque_depth, ivec3(texel, 0)).r) fragment = kNone;
        if (fragment.triangle == PELLUCID_NO_TRIANGLE) head = 0u;
        imageStore(layer_depth, ivec3(texel, layer), vec4(fragment.depth));
        imageStore(layer_surface, ivec3(texel, layer), uvec4(fragment.normal, fragment.triangle, 0u, 0u));
    }
}
