#ifndef PELLUCID_VOLUME_VOLUME_RECORD_GLSL
#define PELLUCID_VOLUME_VOLUME_RECORD_GLSL

// One placement of a volume. Twin of VolumeRecord in volume_records.h.
struct VolumeRecord {
    mat4 voxel_from_world;
    mat4 world_from_voxel;
    vec3 size;           // voxels
    float voxel;         // edge of a voxel in the world, m
    ivec3 first_texel;   // first texel of its box in the images of media
    uint flags;
    ivec4 first_index;   // first texel of its box in the image of the index, for green
    ivec4 first_red;     // likewise for red and blue; equal to first_index without dispersion
    ivec4 first_blue;
};
const uint kDispersiveVolume = 1u;
const uint kMeshVolume = 2u;  // replaces objects of the scene

#endif
