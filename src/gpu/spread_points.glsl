#ifndef PELLUCID_GPU_SPREAD_POINTS_GLSL
#define PELLUCID_GPU_SPREAD_POINTS_GLSL

// Number i of `count` points spread over the unit square (Hammersley).
vec2 spread_point(uint i, uint count) {
    return vec2((float(i) + 0.5) / float(count), float(bitfieldReverse(i)) * 2.3283064e-10);
}

#endif
