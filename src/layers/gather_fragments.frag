#version 460
// Appends every glass fragment to the list of its pixel.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
#include "layers/fragment_list.glsl"
#include "layers/layer_fragment.glsl"

layout(std430, set = 0, binding = 3) buffer Nodes { uint node_count, nodes_reserved[3]; Node nodes[]; };
layout(set = 0, binding = 4, r32ui) uniform uimage2DArray heads;
layout(push_constant) uniform Push { uint drawn_object; };

void main() {
    uint node = atomicAdd(node_count, 1u);
    if (node >= nodes.length()) return;  // the fragment is counted, so the host enlarges the pool
    uint next = imageAtomicExchange(heads, ivec3(gl_FragCoord.xy, 0), node + 1u);
    nodes[node] = Node(rasterised_fragment(), next);
}
