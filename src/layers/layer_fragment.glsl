#ifndef PELLUCID_LAYERS_LAYER_FRAGMENT_GLSL
#define PELLUCID_LAYERS_LAYER_FRAGMENT_GLSL

// The record of a rasterised fragment; both layer builders use it.
#include "layers/layers.glsl"

layout(location = 0) in vec3 world_normal;
layout(location = 1) in float eye_depth;
layout(location = 2) flat in uint triangle;
layout(location = 3) flat in uint mirrored;

Fragment rasterised_fragment() {
    bool back = gl_FrontFacing == (mirrored != 0u);
    return Fragment(eye_depth, pack_unit_vector(normalize(world_normal)), triangle | (back ? PELLUCID_BACK_FACE : 0u));
}

#endif
