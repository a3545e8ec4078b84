#ifndef PELLUCID_VOLUME_BRIGHTEST_LIGHT_GLSL
#define PELLUCID_VOLUME_BRIGHTEST_LIGHT_GLSL

// Voxels keep the brightest light that passes them, and its direction (Ihrke et al. 2007, section 4.2). Needs:
// volume/step_bindings.glsl, volume/light_key.glsl; 64-bit integers and atomics.

layout(constant_id = 6) const uint kTally = 0u;  // 1: add up the light of each voxel; 2: that of its main direction

layout(std430, set = 0, binding = 11) buffer Keys { uint64_t keys[]; };
layout(std430, set = 0, binding = 12) buffer Tally { uint64_t tally[]; };  // two per voxel: all, main direction

const float kMainWay = 0.9659258;  // cosine of 15 degrees, the largest angle to the main direction

// Writes the light of a step to the voxel at the patch's centre.
void keep_light(VolumeRecord volume, LightPlacement placement, PassingLight light) {
    vec3 centre = 0.5 * (middle(light.from) + middle(light.to));
    if (!in_box(centre, volume.size)) return;
    uvec3 at = min(uvec3(centre) >> placement.halvings,
                   uvec3(placement.size_x, placement.size_y, placement.size_z) - 1u);
    uint voxel = placement.first_key + at.x + placement.size_x * (at.y + placement.size_y * at.z);
    float area_m = max(abs(light.area), least_area) * volume.voxel * volume.voxel;
    uint64_t key = light_key(light.power / area_m, light.way);
    uint64_t passed = uint64_t((light.power.r + light.power.g + light.power.b) * light.length_m * power_scale + 0.5);
    if (kTally == 0u) {
        if (key > keys[voxel]) atomicMax(keys[voxel], key);
    } else if (kTally == 1u) {
        atomicMax(keys[voxel], key);
        atomicAdd(tally[2u * voxel], passed);
    } else if (dot(light.way, key_direction(keys[voxel])) > kMainWay) {
        atomicAdd(tally[2u * voxel + 1u], passed);
    }
}

#endif
