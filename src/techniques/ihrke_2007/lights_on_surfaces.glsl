#ifndef PELLUCID_TECHNIQUES_IHRKE_2007_LIGHTS_ON_SURFACES_GLSL
#define PELLUCID_TECHNIQUES_IHRKE_2007_LIGHTS_ON_SURFACES_GLSL

// What lights shine on an opaque surface, through volumes and past them. Objects cast no shadows.
#include "gpu/punctual_light.glsl"
#include "techniques/ihrke_2007/light_bindings.glsl"

layout(std430, set = 0, binding = 35) readonly buffer Lights { PunctualLight lights[]; };

// In a volume: what its voxels keep, less what comes from behind. False: the place is in none.
bool irradiance_in_volume(vec3 position, vec3 normal, out vec3 irradiance) {
    irradiance = vec3(0.0);
    for (uint i = 0u; i < volume_count; ++i) {
        vec3 x = voxel_position(volumes[i], position);
        if (!in_box(x, volumes[i].size)) continue;
        PlaceLight light = light_at(placements[i], x);
        vec3 way = mat3(volumes[i].world_from_voxel) * light.way / volumes[i].voxel;
        irradiance = light.fluence * max(-dot(way, normal), 0.0);
        return true;
    }
    return false;
}

// W/m2. `normal`: unit, on the side that is looked at.
vec3 irradiance_of_lights(vec3 position, vec3 normal) {
    vec3 arrived, without_volumes;
    bool receives = receiver_irradiance(receiver_count, position, arrived, without_volumes);
    vec3 sum;
    if (!receives && irradiance_in_volume(position, normal, sum)) return sum;
    // All lights as if there were no volumes, less what went towards them, and what has become of that.
    sum = arrived - without_volumes;
    for (uint i = 0u; i < light_count; ++i) {
        ArrivingLight arriving = arriving_light(lights[i], position);
        sum += max(-dot(arriving.way, normal), 0.0) * arriving.irradiance * lights[i].intensity;
    }
    return max(sum, vec3(0.0));
}

#endif
