#version 460
// Transforms corners of triangles for fragment shaders that evaluate materials.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };

#include "gpu/vertices.glsl"
layout(std430, set = 0, binding = 22) readonly buffer Appearance { float appearance[]; };
#include "gpu/appearance.glsl"

layout(push_constant) uniform Push { uint drawn_object; };  // set by Recorder::draw

layout(location = 0) out vec3 world_normal;
layout(location = 1) out vec4 texcoords;  // first set, second set
layout(location = 2) out vec4 vertex_color;
layout(location = 3) flat out uint material_index;
layout(location = 4) flat out uint triangle;

invariant gl_Position;

void main() {
    ObjectRecord object = objects[drawn_object];
    uint vertex = indices[gl_VertexIndex];
    vec4 view = frame.view_from_world * (object.world_from_object * vec4(vertex_position(vertex), 1.0));
    gl_Position = frame.clip_from_view * view;
    world_normal = mat3(object.world_from_object_normal) * vertex_normal(vertex);
    texcoords = vertex_texcoords(vertex);
    vertex_color = vertex_color_of(vertex);
    material_index = object.material;
    triangle = object.first_triangle + (uint(gl_VertexIndex) - object.first_corner) / 3u;
}
