#version 460
// Transforms all triangles of the scene to world space, for rays that use no map.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
#include "gpu/vertices.glsl"
#include "layers/objects.glsl"
#include "layers/place_triangle.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Push {
    uint triangle_count;
    uint row;  // invocations in a row of the dispatch
};

void main() {
    uint triangle = gl_GlobalInvocationID.y * row + gl_GlobalInvocationID.x;
    if (triangle >= triangle_count) return;
    vec3 v[3];
    place_in_world(triangle, find_object(triangle), v);
}
