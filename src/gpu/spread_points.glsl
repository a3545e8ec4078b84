#ifndef PELLUCID_GPU_SPREAD_POINTS_GLSL
#define PELLUCID_GPU_SPREAD_POINTS_GLSL

// Point i of a Hammersley set of `count` points in the unit square.
vec2 spread_point(uint i, uint count) {
    return vec2((float(i) + 0.5) / float(count), float(bitfieldReverse(i)) * 2.3283064e-10);
}

#endif
