#version 460
// Converts the caller's depths into distances along the view axis.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gpu/frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, set = 0, binding = 1) readonly buffer CallersDepth { float callers_depth[]; };
layout(set = 0, binding = 2, r32f) writeonly uniform image2DArray background_depth;
layout(push_constant) uniform Push {
    // of the caller's projection: clip z = x z + y, clip w = z z + w, for z along the view axis, negative ahead
    vec4 z_and_w;
    float far_depth;  // depth of texels without geometry
};

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID.xy, 0);
    if (at.x >= int(frame.width) || at.y >= int(frame.height)) return;
    float stored = callers_depth[at.y * int(frame.width) + at.x];
    float z = (z_and_w.y - stored * z_and_w.w) / (stored * z_and_w.z - z_and_w.x);
    bool drawn = stored != far_depth && z < 0.0;
    imageStore(background_depth, at, vec4(drawn ? -z : PELLUCID_EMPTY_DEPTH, 0.0, 0.0, 0.0));
}
