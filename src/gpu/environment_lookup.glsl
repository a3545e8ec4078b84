#ifndef PELLUCID_GPU_ENVIRONMENT_LOOKUP_GLSL
#define PELLUCID_GPU_ENVIRONMENT_LOOKUP_GLSL

// Radiance of the current environment. Needs: frame, environment_map (texture2D).
#include "gpu/environment.glsl"

// Programs for one kind of environment define PELLUCID_ENVIRONMENT_KIND. Otherwise some drivers evaluate all kinds for
// every pixel.
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
