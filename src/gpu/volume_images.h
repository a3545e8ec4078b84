#pragma once

#include "gpu/memory.h"

#include <cstdint>

namespace pellucid {

/// Volumes of a scene in device memory, all in the same images, each in a box of its own (volume/upload_volumes.h fills
/// them, volume/volume_field.glsl reads them). Lengths are in voxels, so that a placement that scales its volume scales
/// what a ray meets with it. What no volume has, is one texel of zeros.
struct VolumeImages {
    GpuImage index;           ///< RGBA32F: the index of a row of four voxels along x, the second the texel's own
    GpuImage bricks;          ///< RG32F per 8^3 cells of it: the index, where it is the same in all; 1: media are, too
    GpuImage absorption;      ///< RGBA16F: sigma_a per voxel; a: boundary
    GpuImage scattering;      ///< RGBA16F: sigma_s per voxel; a: g
    GpuImage emission;        ///< RGBA16F: radiance that a voxel's length adds
    Buffer records;           ///< VolumeRecord per placement, boxes of less content first
    std::uint32_t count = 0;  ///< placements
    bool absorbs = false, scatters = false, emits = false, reflects = false, disperses = false;
    bool overlapping = false;  ///< boxes of two placements may have places in common
};

}  // namespace pellucid
