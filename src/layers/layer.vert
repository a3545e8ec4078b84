#version 460
// Transforms the corners of glass triangles for every layer builder that rasterises in hardware.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
#include "gpu/vertices.glsl"

layout(push_constant) uniform Push { uint drawn_object; };  // set by Recorder::draw

layout(location = 0) flat out uint triangle;  // with PELLUCID_BACK_FACE if the object mirrors its mesh

invariant gl_Position;

void main() {
    ObjectRecord object = objects[drawn_object];
    vec3 position = vertex_position(indices[gl_VertexIndex]);
    vec4 view = frame.view_from_world * (object.world_from_object * vec4(position, 1.0));
    gl_Position = frame.clip_from_view * view;
    triangle = object.first_triangle + (uint(gl_VertexIndex) - object.first_corner) / 3u;
    if (object.mirrored != 0u) triangle |= PELLUCID_BACK_FACE;
}
