#ifndef PELLUCID_LAYERS_FRAGMENT_LIST_GLSL
#define PELLUCID_LAYERS_FRAGMENT_LIST_GLSL

// An entry of a pixel's list of fragments. kFragmentNodeSize in layers.h is its size.
#include "layers/layers.glsl"

struct Node {
    Fragment fragment;
    uint next;  // index + 1 of the next node, 0 at the end
};

#endif
