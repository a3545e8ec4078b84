#ifndef PELLUCID_TECHNIQUES_IHRKE_2007_LIGHTS_ON_SURFACES_GLSL
#define PELLUCID_TECHNIQUES_IHRKE_2007_LIGHTS_ON_SURFACES_GLSL

// What lights shine on an opaque surface, through volumes and past them. Objects cast shadows in the light of volumes only.
// Needs: light/photon_lookup.glsl.
#include "gpu/punctual_light.glsl"

layout(std430, set = 0, binding = 35) readonly buffer Lights { PunctualLight lights[]; };

// W/m2. `normal`: unit, on the side that is looked at.
vec3 irradiance_of_lights(vec3 position, vec3 normal) {
    // Photons have what arrives of the light that lights send to volumes, less what it would have been straight
    // (volume/land_light.comp).
    vec3 sum = photon_light(position, normal, irradiance_alone());
    for (uint i = 0u; i < light_count; ++i) {
        ArrivingLight arriving = arriving_light(lights[i], position);
        sum += max(-dot(arriving.way, normal), 0.0) * arriving.irradiance * lights[i].intensity;
    }
    return max(sum, vec3(0.0));
}

#endif
