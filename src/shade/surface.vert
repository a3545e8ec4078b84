#version 460
// Transforms corners of triangles whose material is looked at.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };

layout(location = 0) in vec3 object_position;
layout(location = 1) in vec3 object_normal;
layout(location = 2) in vec2 first_texcoord;
layout(location = 3) in vec2 second_texcoord;
layout(location = 4) in vec4 color;

layout(location = 0) out vec3 world_normal;
layout(location = 1) out vec4 texcoords;  // first set, second set
layout(location = 2) out vec4 vertex_color;
layout(location = 3) out float eye_depth;
layout(location = 4) flat out uint material_index;
layout(location = 5) flat out uint triangle;

invariant gl_Position;

void main() {
    ObjectRecord object = objects[gl_InstanceIndex];
    vec4 view = frame.view_from_world * (object.world_from_object * vec4(object_position, 1.0));
    gl_Position = frame.clip_from_view * view;
    world_normal = mat3(object.world_from_object_normal) * object_normal;
    texcoords = vec4(first_texcoord, second_texcoord);
    vertex_color = color;
    eye_depth = -view.z;
    material_index = object.material;
    triangle = object.first_triangle + (uint(gl_VertexIndex) - object.first_vertex) / 3u;
}
