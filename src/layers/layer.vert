#version 460
// Transforms corners of glass triangles; both layer builders use it.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };

layout(location = 0) in vec3 object_position;
layout(location = 1) in vec3 object_normal;

layout(location = 0) out vec3 world_normal;
layout(location = 1) out float eye_depth;
layout(location = 2) flat out uint triangle;
layout(location = 3) flat out uint mirrored;

invariant gl_Position;

void main() {
    ObjectRecord object = objects[gl_InstanceIndex];
    vec4 view = frame.view_from_world * (object.world_from_object * vec4(object_position, 1.0));
    gl_Position = frame.clip_from_view * view;
    world_normal = mat3(object.world_from_object_normal) * object_normal;
    eye_depth = -view.z;
    triangle = object.first_triangle + (uint(gl_VertexIndex) - object.first_vertex) / 3u;
    mirrored = object.mirrored;
}
