#ifndef PELLUCID_VOLUME_VOLUME_BOXES_GLSL
#define PELLUCID_VOLUME_VOLUME_BOXES_GLSL

// Look-ups of the boxes of placed volumes. Needs: volumes (VolumeRecord[], smaller boxes first), volume_count,
// kSharpInterfaces.

#include "volume/box.glsl"

const uint kNoVolume = 0xffffffffu;

vec3 voxel_position(VolumeRecord volume, vec3 world) { return (volume.voxel_from_world * vec4(world, 1.0)).xyz; }
// Transforms a unit direction to a unit direction in the voxels' frame.
vec3 voxel_direction(VolumeRecord volume, vec3 world) { return mat3(volume.voxel_from_world) * world * volume.voxel; }

// The kind of volumes that a ray can meet. With kSharpInterfaces, solids hold volumes: a ray meets these inside the
// solids, and the other volumes outside.
const uint kAnyVolume = 0u, kFreeVolume = 1u, kHeldVolume = 2u;
uint volumes_of(bool in_holder, uint proxy_mode) {
    return proxy_mode != kSharpInterfaces ? kAnyVolume : in_holder ? kHeldVolume : kFreeVolume;
}

// The next volume on a straight ray, and its distance, m. If the ray is inside volumes, the smallest of them.
uint next_volume(vec3 position, vec3 direction, uint of_kind, out float distance_m) {
    uint found = kNoVolume;
    distance_m = 1e30;
    for (uint i = 0u; i < volume_count; ++i) {
        if (of_kind != kAnyVolume && ((volumes[i].flags & kMeshVolume) != 0u) != (of_kind == kHeldVolume)) continue;
        float near, far;
        clip_to_box(volumes[i], voxel_position(volumes[i], position), voxel_direction(volumes[i], direction), near, far);
        if (far - near > kLeastCrossing && near * volumes[i].voxel < distance_m) {
            distance_m = near * volumes[i].voxel;
            found = i;
        }
    }
    return found;
}

// Whether a position lies in a smaller volume than number `own`, which takes precedence.
bool inside_smaller(uint own, vec3 world) {
    for (uint i = 0u; i < own; ++i) {
        vec3 x = voxel_position(volumes[i], world);
        if (all(greaterThan(x, vec3(kLeastCrossing))) && all(lessThan(x, volumes[i].size - kLeastCrossing))) return true;
    }
    return false;
}

#endif
