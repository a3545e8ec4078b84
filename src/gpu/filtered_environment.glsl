#ifndef PELLUCID_GPU_FILTERED_ENVIRONMENT_GLSL
#define PELLUCID_GPU_FILTERED_ENVIRONMENT_GLSL

// The environment as a rough surface reflects it. Needs: everything that gpu/environment_lookup.glsl needs, and
// filtered_environment (texture2D; see gpu/environment_images.h).
#include "gpu/environment_lookup.glsl"
#include "gpu/filter_levels.glsl"
#include "gpu/octahedral_map.glsl"

vec3 filter_level_radiance(int level, vec3 direction) {
    return octahedral_map_value(filtered_environment, filter_level_corner(level), filter_level_size(level), direction).rgb;
}

// Mean radiance of the environment over the GGX lobe around a unit direction, seen along the lobe's axis. `roughness`:
// perceptual, 0..1; 0 is the environment itself. Every roughness has the same mean over all directions.
vec3 filtered_environment_radiance(vec3 direction, float roughness) {
    float position = clamp(roughness, 0.0, 1.0) * float(PELLUCID_FILTER_LEVELS);
    if (position <= 0.0) return environment_radiance(direction);
    int level = min(int(position), PELLUCID_FILTER_LEVELS - 1);
    vec3 sharper = level == 0 ? environment_radiance(direction) : filter_level_radiance(level, direction);
    return mix(sharper, filter_level_radiance(level + 1, direction), position - float(level));
}

// Irradiance / pi of the environment on a surface with a unit normal, in more detail than diffuse_radiance().
vec3 detailed_diffuse_radiance(vec3 normal) {
    return octahedral_map_value(filtered_environment, kIrradianceTableCorner, kIrradianceTableSize, normal).rgb;
}

#endif
