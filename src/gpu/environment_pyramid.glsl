#ifndef PELLUCID_GPU_ENVIRONMENT_PYRAMID_GLSL
#define PELLUCID_GPU_ENVIRONMENT_PYRAMID_GLSL

// Octahedral maps of the environment's mean radiance (rgb) and of what their texels see (a: solid angle, sr), each
// half as wide as the one before: the first at the image's left, the others below each other at its right.

const int kPyramidSize = PELLUCID_PYRAMID_SIZE;

int pyramid_size(int level) {
    return kPyramidSize >> level;
}

ivec2 pyramid_corner(int level) {
    return level == 0 ? ivec2(0) : ivec2(kPyramidSize, kPyramidSize - (kPyramidSize >> (level - 1)));
}

#endif
