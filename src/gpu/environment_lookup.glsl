#ifndef PELLUCID_GPU_ENVIRONMENT_LOOKUP_GLSL
#define PELLUCID_GPU_ENVIRONMENT_LOOKUP_GLSL

// Radiance of the environment that is set. Needs: frame, environment_map (texture2D).
#include "gpu/environment.glsl"

// Programs that are made for one kind of environment define PELLUCID_ENVIRONMENT_KIND: some drivers run all kinds
// for every pixel otherwise.
#ifndef PELLUCID_ENVIRONMENT_KIND
#define PELLUCID_ENVIRONMENT_KIND frame.environment_kind
#endif

vec3 environment_radiance(vec3 direction) {
    EnvironmentPlacement placement =
        EnvironmentPlacement(frame.environment_cosine, frame.environment_sine, frame.environment_intensity);
    return placed_radiance(PELLUCID_ENVIRONMENT_KIND, environment_map, frame.environment_uniform.rgb, placement,
                           direction);
}

#endif
