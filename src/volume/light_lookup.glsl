#ifndef PELLUCID_VOLUME_LIGHT_LOOKUP_GLSL
#define PELLUCID_VOLUME_LIGHT_LOOKUP_GLSL

// Look-ups of the light that was traced through volumes (wavefront.h).
//
// Needs: #extension GL_EXT_samplerless_texture_functions : require; texture3D light_irradiance, light_direction; buffer
// Placements { LightPlacement placements[]; }.

#include "optics/phase.glsl"
#include "volume/light_records.h"

// Light at a position in a volume: fluence rate, W/m2, and mean direction. The latter is shorter than 1 if directions
// differ from each other.
struct PlaceLight {
    vec3 fluence;
    vec3 way;
};

// Interpolates linearly between the centres of the voxels of light. `x`: voxels.
PlaceLight light_at(LightPlacement placement, vec3 x) {
    vec3 size = vec3(placement.size_x, placement.size_y, placement.size_z);
    vec3 position = clamp(x / float(1u << placement.halvings) - 0.5, vec3(0.0), size - 1.0);
    vec3 corner = min(floor(position), max(size - 2.0, vec3(0.0)));
    vec3 w = position - corner;
    ivec3 first = ivec3(placement.first_x, placement.first_y, placement.first_z), last = first + ivec3(size) - 1;
    PlaceLight light = PlaceLight(vec3(0.0), vec3(0.0));
    for (int k = 0; k < 8; ++k) {
        ivec3 offset = ivec3(k & 1, k >> 1 & 1, k >> 2), at = min(first + ivec3(corner) + offset, last);
        vec3 shares = mix(1.0 - w, w, vec3(offset));
        vec3 fluence = shares.x * shares.y * shares.z * texelFetch(light_irradiance, at, 0).rgb;
        light.fluence += fluence;
        light.way += (fluence.r + fluence.g + fluence.b) * texelFetch(light_direction, at, 0).xyz;
    }
    light.way /= max(light.fluence.r + light.fluence.g + light.fluence.b, 1e-30);
    return light;
}

// Radiance that a voxel's length of medium scatters once into the unit direction `way`, in the frame of the voxels.
// `x`: voxels of the volume `own`. `scattering`: sigma_s per voxel and g, from the volume's image. The mean cosine of
// the scattered light is exact even if light comes from several directions.
vec3 scattered_radiance(uint own, vec3 x, vec3 way, vec4 scattering) {
    PlaceLight light = light_at(placements[own], x);
    float agreement = min(length(light.way), 1.0);
    if (!(agreement > 0.0)) return scattering.rgb * light.fluence * henyey_greenstein(0.0, 0.0);
    return scattering.rgb * light.fluence *
           henyey_greenstein(clamp(dot(light.way / agreement, way), -1.0, 1.0), agreement * scattering.a);
}

#endif
