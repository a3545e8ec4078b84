#version 460
// Dual depth peeling (Bavoil & Myers 2008). Finds the nearest and the farthest fragment between the two depths that the
// previous pass found. Also collects the triangles at these two depths.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
#include "layers/dual_peel.glsl"
#include "layers/layer_fragment.glsl"

layout(set = 0, binding = 2, rgba32f) readonly uniform image2D last_near;
layout(set = 0, binding = 3, rgba32f) readonly uniform image2D last_far;
layout(push_constant) uniform Push {
    uint drawn_object;
    uint first;
};

layout(location = 0) out vec4 out_near;
layout(location = 1) out vec4 out_far;

void main() {
    Fragment fragment = rasterised_fragment();
    if (first != 0u) {
        out_near = vec4(-fragment.depth, 0.0, 0.0, 0.0);
        out_far = vec4(fragment.depth, 0.0, 0.0, 0.0);
        return;
    }
    ivec2 texel = ivec2(gl_FragCoord.xy);
    float nearest = -imageLoad(last_near, texel).r, farthest = imageLoad(last_far, texel).r;
    if (fragment.depth < nearest || fragment.depth > farthest) discard;

    vec2 depths = vec2(-PELLUCID_EMPTY_DEPTH);
    if (fragment.depth > nearest && fragment.depth < farthest) depths = vec2(-fragment.depth, fragment.depth);
    uint key = triangle_key(fragment.triangle);
    vec3 here = vec3(rising(key), falling(key), 1.0);
    out_near = vec4(depths.x, fragment.depth == nearest ? here : vec3(0.0));
    out_far = vec4(depths.y, fragment.depth == farthest ? here : vec3(0.0));
}
