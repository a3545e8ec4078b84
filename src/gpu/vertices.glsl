#ifndef PELLUCID_GPU_VERTICES_GLSL
#define PELLUCID_GPU_VERTICES_GLSL

// The scene's triangles, in the frames of their meshes; see gpu_scene.h.

layout(std430, set = 0, binding = 20) readonly buffer Indices { uint indices[]; };
layout(std430, set = 0, binding = 21) readonly buffer Vertices { float vertices[]; };  // kVertexStride

vec3 vertex_position(uint vertex) {
    return vec3(vertices[6u * vertex], vertices[6u * vertex + 1u], vertices[6u * vertex + 2u]);
}

vec3 vertex_normal(uint vertex) {
    return vec3(vertices[6u * vertex + 3u], vertices[6u * vertex + 4u], vertices[6u * vertex + 5u]);
}

#endif
