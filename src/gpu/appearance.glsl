#ifndef PELLUCID_GPU_APPEARANCE_GLSL
#define PELLUCID_GPU_APPEARANCE_GLSL

// Texture coordinates and colours of vertices; see gpu_scene.h. Needs: appearance (float[]).

const uint kAppearanceStride = 5u;

// Texture coordinates of both sets.
vec4 vertex_texcoords(uint vertex) {
    uint at = kAppearanceStride * vertex;
    return vec4(appearance[at], appearance[at + 1u], appearance[at + 2u], appearance[at + 3u]);
}

vec4 vertex_color_of(uint vertex) { return unpackUnorm4x8(floatBitsToUint(appearance[kAppearanceStride * vertex + 4u])); }

#endif
