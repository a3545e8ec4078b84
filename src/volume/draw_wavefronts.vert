#version 460
// Draws a patch of a wavefront as two triangles.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
#include "volume/light_records.h"

layout(std430, set = 0, binding = 1) readonly buffer Shown { ShownPatch shown[]; };

layout(location = 0) out vec3 world_position;
layout(location = 1) flat out vec3 irradiance;

void main() {
    const int kCorners[6] = int[](0, 1, 2, 0, 2, 3);
    ShownPatch own = shown[gl_VertexIndex / 6];
    world_position = own.position[kCorners[gl_VertexIndex % 6]].xyz;
    irradiance = vec3(own.position[0].w, own.position[1].w, own.position[2].w);
    gl_Position = frame.clip_from_view * frame.view_from_world * vec4(world_position, 1.0);
}
