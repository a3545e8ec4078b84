#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_LIGHT_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_LIGHT_GLSL

// Light that the paths of a pixel gather. Needs: path_state.glsl.
#include "gpu/light_parts.glsl"

layout(set = 0, binding = 7, rgba32f) uniform image2DArray path_radiance;
layout(set = 0, binding = 8, rgba32f) uniform image2DArray reflected_radiance;

layout(set = 0, binding = 47, rgba32f) uniform image2DArray surface_radiance;  // light of the opaque surfaces in pixels

// Adds light of a path with this mark.
void add_light(ivec2 texel, uint mark, vec3 light) {
    ivec3 at = ivec3(texel, 0);
    if ((mark & kOpaquePixel) != 0u) imageStore(surface_radiance, at, imageLoad(surface_radiance, at) + vec4(light, 0.0));
    else if ((mark & kOuterBranch) != 0u) imageStore(reflected_radiance, at, imageLoad(reflected_radiance, at) + vec4(light, 0.0));
    else {
        // Light from a shadow ray does not hide the background of the glass.
        vec4 before = imageLoad(path_radiance, at);
        imageStore(path_radiance, at, vec4(before.rgb + light, (mark & kToLight) != 0u ? before.a : 1.0));
    }
}

#endif
