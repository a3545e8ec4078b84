#ifndef PELLUCID_LAYERS_DUAL_PEEL_GLSL
#define PELLUCID_LAYERS_DUAL_PEEL_GLSL

// Contents of a texel after a pass of dual depth peeling. The near side and the far side have the same layout.
//   r    depth of the surface found, negated on the near side; -PELLUCID_EMPTY_DEPTH: no surface was left
// The other channels describe the triangles at the depth that the previous pass found:
//   g    the triangle with the highest index, as rising(key); 0: none
//   b    the triangle with the lowest index, as falling(key)
//   a    number of triangles
// Blending keeps the maximum of r, g and b, and adds up a.
#include "layers/layers.glsl"

// Positive normal floats compare like their bit patterns. kMostTriangles in dual_peel_layers.cpp keeps keys in range.
const uint kSmallestNormal = 0x00800000u, kLargestFinite = 0x7f7fffffu;

// Keys have the same order as triangle_index().
uint triangle_key(uint triangle) { return triangle_index(triangle) << 1 | (back_face(triangle) ? 1u : 0u); }
uint triangle_of_key(uint key) { return key >> 1 | ((key & 1u) != 0u ? PELLUCID_BACK_FACE : 0u); }

float rising(uint key) { return uintBitsToFloat(kSmallestNormal + key); }
float falling(uint key) { return uintBitsToFloat(kLargestFinite - key); }
uint highest_triangle(vec4 texel) { return triangle_of_key(floatBitsToUint(texel.g) - kSmallestNormal); }
uint lowest_triangle(vec4 texel) { return triangle_of_key(kLargestFinite - floatBitsToUint(texel.b)); }

#endif
