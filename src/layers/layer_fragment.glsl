#ifndef PELLUCID_LAYERS_LAYER_FRAGMENT_GLSL
#define PELLUCID_LAYERS_LAYER_FRAGMENT_GLSL

// The record of a fragment from the hardware rasteriser. Needs: frame (FrameConstants).
#include "gpu/fragment_depth.glsl"
#include "layers/layers.glsl"

layout(location = 0) flat in uint triangle;

Fragment rasterised_fragment() {
    return Fragment(eye_depth(), gl_FrontFacing ? triangle : triangle ^ PELLUCID_BACK_FACE);
}

#endif
