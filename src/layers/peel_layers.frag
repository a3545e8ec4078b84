#version 460
// Depth peeling: keeps the nearest fragment behind the previous layer (Everitt 2001).
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
#include "layers/layer_fragment.glsl"

layout(set = 0, binding = 2, r32f) readonly uniform image2DArray opaque_depth;
layout(set = 0, binding = 3, r32f) readonly uniform image2D last_depth;
layout(set = 0, binding = 4, r32ui) readonly uniform uimage2D last_triangle;
layout(push_constant) uniform Push {
    uint drawn_object;
    uint layer;
    uint hidden_by_opaque;
};

layout(location = 0) out float out_depth;
layout(location = 1) out uint out_triangle;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    Fragment fragment = rasterised_fragment();
    if (layer == 0u) {
        if (hidden_by_opaque != 0u && fragment.depth >= imageLoad(opaque_depth, ivec3(texel, 0)).r) discard;
    } else {
        Fragment last = Fragment(imageLoad(last_depth, texel).r, imageLoad(last_triangle, texel).r);
        if (!is_behind(fragment, last)) discard;
    }
    out_depth = fragment.depth;
    out_triangle = fragment.triangle;
    gl_FragDepth = fragment.depth * frame.depth_scale;
}
