#version 460
// Looks up the environment as rough surfaces see it, for a table of directions.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gpu/frame.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 1) readonly buffer Lookups { vec4 lookups[]; };  // direction; w: roughness
layout(std430, set = 0, binding = 2) writeonly buffer Answers { vec4 answers[]; };
layout(set = 0, binding = 3) uniform texture2D environment_map;
layout(set = 0, binding = 4) uniform texture2D filtered_environment;

#include "gpu/filtered_environment.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= lookups.length()) return;
    answers[i] = vec4(filtered_environment_radiance(lookups[i].xyz, lookups[i].w), 1.0);
}
