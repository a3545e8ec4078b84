#ifndef PELLUCID_LAYERS_LAYER_FRAGMENT_GLSL
#define PELLUCID_LAYERS_LAYER_FRAGMENT_GLSL

// The record of a rasterised fragment; every layer builder uses it. Needs: frame (FrameConstants).
#include "gpu/fragment_depth.glsl"
#include "layers/layers.glsl"

layout(location = 0) flat in uint triangle;

Fragment rasterised_fragment() {
    return Fragment(eye_depth(), gl_FrontFacing ? triangle : triangle ^ PELLUCID_BACK_FACE);
}

#endif
