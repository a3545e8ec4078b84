#ifndef PELLUCID_GPU_EMITTED_RADIANCE_GLSL
#define PELLUCID_GPU_EMITTED_RADIANCE_GLSL

// Needs: everything that gpu/texture.glsl needs.
#include "gpu/texture.glsl"

// Emitted radiance of a material at texture coordinates of two sets.
vec3 emitted_radiance(MaterialRecord material, vec2 first_set, vec2 second_set) {
    return material.emission.rgb * sample_texture(material.emission_texture, first_set, second_set).rgb;
}

#endif
