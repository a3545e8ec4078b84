#version 460
// The nearest or farthest surface through which a view ray leaves a solid. The depth test selects it.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
#include "layers/layer_fragment.glsl"

layout(push_constant) uniform Push {
    uint drawn_object;
    uint farthest;
};

layout(location = 0) out float out_depth;
layout(location = 1) out uint out_triangle;

void main() {
    Fragment fragment = rasterised_fragment();
    if (!back_face(fragment.triangle)) discard;
    out_depth = fragment.depth;
    out_triangle = fragment.triangle;
    float scaled = fragment.depth * frame.depth_scale;  // 0..1
    gl_FragDepth = farthest != 0u ? 1.0 - scaled : scaled;
}
