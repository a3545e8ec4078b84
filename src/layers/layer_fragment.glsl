#ifndef PELLUCID_LAYERS_LAYER_FRAGMENT_GLSL
#define PELLUCID_LAYERS_LAYER_FRAGMENT_GLSL

// The record of a rasterised fragment; every layer builder uses it. Needs: frame (FrameConstants).
#include "layers/layers.glsl"

layout(location = 0) flat in uint triangle;

// The rasteriser interpolates 1/depth and z in any case: a varying for the depth would cost every triangle more.
float eye_depth() {
    return frame.orthographic != 0u ? mix(frame.near_plane, frame.far_plane, gl_FragCoord.z) : 1.0 / gl_FragCoord.w;
}

Fragment rasterised_fragment() {
    return Fragment(eye_depth(), gl_FrontFacing ? triangle : triangle ^ PELLUCID_BACK_FACE);
}

#endif
