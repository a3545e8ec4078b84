#ifndef PELLUCID_LAYERS_LAYER_FRAGMENT_GLSL
#define PELLUCID_LAYERS_LAYER_FRAGMENT_GLSL

// The record of a rasterised fragment; every layer builder uses it.
#include "layers/layers.glsl"

layout(location = 0) in float eye_depth;
layout(location = 1) flat in uint triangle;

Fragment rasterised_fragment() {
    return Fragment(eye_depth, gl_FrontFacing ? triangle : triangle ^ PELLUCID_BACK_FACE);
}

#endif
