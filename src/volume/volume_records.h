#pragma once

#include "core/math.h"

#include <cstdint>

namespace pellucid {

/// One placement of a volume; twin of VolumeRecord in volume_record.glsl.
struct VolumeRecord {
    glm::mat4 voxel_from_world;  ///< voxel coordinates: 0 to size over the box, voxel centres at + 1/2
    glm::mat4 world_from_voxel;
    glm::vec3 size;          ///< voxels
    float voxel;             ///< edge of a voxel in the world, m
    glm::ivec3 first_texel;  ///< first texel of its box in the images of media
    std::uint32_t flags;     ///< kDispersiveVolume, kMeshVolume
    glm::ivec4 first_index;  ///< first texel of its box in the image of the index, for green
    glm::ivec4 first_red, first_blue;
};
static_assert(sizeof(VolumeRecord) == 208);

inline constexpr std::uint32_t kDispersiveVolume = 1;
inline constexpr std::uint32_t kMeshVolume = 2;  ///< replaces objects of the scene

}  // namespace pellucid
