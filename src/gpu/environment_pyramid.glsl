#ifndef PELLUCID_GPU_ENVIRONMENT_PYRAMID_GLSL
#define PELLUCID_GPU_ENVIRONMENT_PYRAMID_GLSL

// Octahedral maps of the environment: mean radiance (rgb) and solid angle (a, sr) per texel. Each level is half as wide
// as the one before. The first level is at the image's left, the others are below each other at its right.

const int kPyramidSize = PELLUCID_PYRAMID_SIZE;

int pyramid_size(int level) {
    return kPyramidSize >> level;
}

ivec2 pyramid_corner(int level) {
    return level == 0 ? ivec2(0) : ivec2(kPyramidSize, kPyramidSize - (kPyramidSize >> (level - 1)));
}

#endif
