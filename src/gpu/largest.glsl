#ifndef PELLUCID_GPU_LARGEST_GLSL
#define PELLUCID_GPU_LARGEST_GLSL

float largest(vec3 v) { return max(v.r, max(v.g, v.b)); }

#endif
