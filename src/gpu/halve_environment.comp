#version 460
// Computes a level of the environment's pyramid from the next finer one. No light is lost or gained.
#extension GL_GOOGLE_include_directive : require
#include "gpu/structs.h"
#include "gpu/environment_pyramid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, rgba32f) uniform image2DArray pyramid;
layout(push_constant) uniform Push { int level; };

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(pyramid_size(level))))) return;
    ivec2 finer = pyramid_corner(level - 1) + 2 * texel;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        vec4 part = imageLoad(pyramid, ivec3(finer + ivec2(i & 1, i >> 1), 0));
        sum += part.a * vec4(part.rgb, 1.0);
    }
    imageStore(pyramid, ivec3(pyramid_corner(level) + texel, 0), vec4(sum.rgb / sum.a, sum.a));
}
