#ifndef PELLUCID_LAYERS_LAYERS_GLSL
#define PELLUCID_LAYERS_LAYERS_GLSL

// Layer records; see layers.h.
#include "gpu/structs.h"
#include "gpu/octahedral.glsl"

struct Fragment {
    float depth;    // metres along -Z of the view
    uint triangle;  // with PELLUCID_BACK_FACE
};

const Fragment kNoFragment = Fragment(PELLUCID_EMPTY_DEPTH, PELLUCID_NO_TRIANGLE);

uint triangle_index(uint triangle) { return triangle & ~PELLUCID_BACK_FACE; }
bool back_face(uint triangle) { return (triangle & PELLUCID_BACK_FACE) != 0u; }

// The order of layers: by depth, then by triangle index.
bool is_behind(Fragment a, Fragment b) {
    return a.depth > b.depth || (a.depth == b.depth && triangle_index(a.triangle) > triangle_index(b.triangle));
}

#endif
