#ifndef PELLUCID_VOLUME_LIGHT_LOOKUP_GLSL
#define PELLUCID_VOLUME_LIGHT_LOOKUP_GLSL

// The light that was traced through volumes (wavefront.h), at a place in a volume.
//
// Needs: #extension GL_EXT_samplerless_texture_functions : require; texture3D light_irradiance, light_direction; buffer
// Placements { LightPlacement placements[]; }.

#include "optics/phase.glsl"
#include "volume/light_records.h"

// Light at a place in a volume, which is in voxels: fluence rate, W/m2, and the mean of its ways, shorter than 1 where they
// differ. Interpolated linearly between the middles of the voxels of light.
struct PlaceLight {
    vec3 fluence;
    vec3 way;
};

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

// Radiance that a voxel's length of medium scatters in a unit direction `way`, the way that the scattered light goes
// (frame of the voxels). x: voxels of the volume `own`; scattering: sigma_s per voxel, and g, as the volume's image has
// them. Light is scattered once. Of light that comes from several ways the mean cosine of what is scattered is exact.
vec3 scattered_radiance(uint own, vec3 x, vec3 way, vec4 scattering) {
    PlaceLight light = light_at(placements[own], x);
    float agreement = min(length(light.way), 1.0);
    if (!(agreement > 0.0)) return scattering.rgb * light.fluence * henyey_greenstein(0.0, 0.0);
    return scattering.rgb * light.fluence *
           henyey_greenstein(clamp(dot(light.way / agreement, way), -1.0, 1.0), agreement * scattering.a);
}

#endif
