#ifndef PELLUCID_TECHNIQUES_RAY_TRACING_SURFACE_HIT_GLSL
#define PELLUCID_TECHNIQUES_RAY_TRACING_SURFACE_HIT_GLSL

// What a ray brings back, and what all of this program's shaders are given.
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_buffer_reference_uvec2 : require

const uint kNothing = 0xffffffffu;

struct SurfaceHit {
    vec3 position;          // world, m
    uint object;            // kNothing: the ray met no surface
    vec3 normal;            // world, unit, interpolated; out of the solid
    vec3 geometric_normal;  // world, of the triangle itself, any length; out of the solid
};

layout(push_constant) uniform Push {
    uvec2 vertices;   // device addresses of GpuScene::vertices
    uvec2 indices;    // and GpuScene::indices, which no storage-buffer binding need have room for
    uint max_events;  // K
};

#endif
