#ifndef PELLUCID_LAYERS_DUAL_PEEL_GLSL
#define PELLUCID_LAYERS_DUAL_PEEL_GLSL

// What a pass of dual depth peeling leaves in a texel, of the near side and of the far side alike:
//   r    depth of the surface found, near side negated; -PELLUCID_EMPTY_DEPTH: none was left
// and of the triangles at the depth that the pass before found:
//   g    the highest, rising(key), 0: none
//   b    the lowest, falling(key)
//   a    how many there are
// Blending keeps the maximum of r, g and b, and adds up a.
#include "layers/layers.glsl"

// Positive normal floats compare as their bits do. kMostTriangles in dual_peel_layers.cpp keeps keys in range.
const uint kSmallestNormal = 0x00800000u, kLargestFinite = 0x7f7fffffu;

// Orders as triangle_index() does.
uint triangle_key(uint triangle) { return triangle_index(triangle) << 1 | (back_face(triangle) ? 1u : 0u); }
uint triangle_of_key(uint key) { return key >> 1 | ((key & 1u) != 0u ? PELLUCID_BACK_FACE : 0u); }

float rising(uint key) { return uintBitsToFloat(kSmallestNormal + key); }
float falling(uint key) { return uintBitsToFloat(kLargestFinite - key); }
uint highest_triangle(vec4 texel) { return triangle_of_key(floatBitsToUint(texel.g) - kSmallestNormal); }
uint lowest_triangle(vec4 texel) { return triangle_of_key(kLargestFinite - floatBitsToUint(texel.b)); }

#endif
