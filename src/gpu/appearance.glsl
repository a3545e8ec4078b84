#ifndef PELLUCID_GPU_APPEARANCE_GLSL
#define PELLUCID_GPU_APPEARANCE_GLSL

// What textures and colours want to know of a vertex; see gpu_scene.h. Needs: appearance (float[]).

const uint kAppearanceStride = 5u;

// Both sets.
vec4 vertex_texcoords(uint vertex) {
    uint at = kAppearanceStride * vertex;
    return vec4(appearance[at], appearance[at + 1u], appearance[at + 2u], appearance[at + 3u]);
}

vec4 vertex_color_of(uint vertex) { return unpackUnorm4x8(floatBitsToUint(appearance[kAppearanceStride * vertex + 4u])); }

#endif
