#ifndef PELLUCID_SHADE_ENVIRONMENT_LOOKUP_GLSL
#define PELLUCID_SHADE_ENVIRONMENT_LOOKUP_GLSL

// Radiance of the environment that is set. Needs: frame, environment_map (texture2D).
#include "shade/environment.glsl"

vec3 environment_radiance(vec3 direction) {
    if (frame.environment_kind == 0u) return map_radiance(environment_map, direction);
    return procedural_radiance(frame.environment_kind, frame.environment_uniform.rgb, direction);
}

#endif
