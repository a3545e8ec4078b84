#ifndef PELLUCID_GPU_HASH_GLSL
#define PELLUCID_GPU_HASH_GLSL

// Jarzynski & Olano, "Hash functions for GPU rendering", JCGT 2020: pcg3d.
uvec3 hash(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

#endif
