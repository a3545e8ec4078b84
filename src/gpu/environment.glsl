#ifndef PELLUCID_GPU_ENVIRONMENT_GLSL
#define PELLUCID_GPU_ENVIRONMENT_GLSL

// Light from infinitely far away; twin of scene/environment.cpp.
// scene/environment_formulas.glsl defines `vec3 procedural_radiance(uint kind, vec3 uniform_radiance, vec3 d)`.
// Includers with a map need `#extension GL_EXT_samplerless_texture_functions : require`.

#include "scene/environment_formulas.glsl"

// Radiance of an equirectangular map from direction d: bilinear, wrapping in u, clamped in v, texel centres at
// (i + 1/2) / size. The shader interpolates, because hardware filtering of 32-bit float images is optional.
vec3 map_radiance(texture2D map, vec3 d) {
    ivec2 size = textureSize(map, 0);
    vec2 position = equirect_from_direction(d) * vec2(size) - 0.5;
    vec2 corner = floor(position);
    vec2 weight = position - corner;
    ivec2 low = ivec2(corner);
    int left = low.x < 0 ? size.x - 1 : low.x;
    int right = low.x + 1 >= size.x ? 0 : low.x + 1;
    int top = clamp(low.y, 0, size.y - 1);
    int bottom = clamp(low.y + 1, 0, size.y - 1);
    vec3 upper = mix(texelFetch(map, ivec2(left, top), 0).rgb,
                     texelFetch(map, ivec2(right, top), 0).rgb, weight.x);
    vec3 lower = mix(texelFetch(map, ivec2(left, bottom), 0).rgb,
                     texelFetch(map, ivec2(right, bottom), 0).rgb, weight.x);
    return mix(upper, lower, weight.y);
}

// Cosine and sine of an environment's rotation about +Y, and its intensity.
struct EnvironmentPlacement {
    float cosine, sine, intensity;
};

vec3 environment_from_world(EnvironmentPlacement placement, vec3 d) {
    return vec3(placement.cosine * d.x - placement.sine * d.z, d.y, placement.sine * d.x + placement.cosine * d.z);
}

// Radiance of environment `kind` from world direction d.
vec3 placed_radiance(uint kind, texture2D map, vec3 uniform_radiance, EnvironmentPlacement placement, vec3 d) {
    vec3 turned = environment_from_world(placement, d);
    vec3 full = kind == kEnvironmentMap ? map_radiance(map, turned) : procedural_radiance(kind, uniform_radiance, turned);
    return placement.intensity * full;
}

#endif
