#pragma once

#include "gpu/memory.h"

#include <cstdint>

namespace pellucid {

/// Volumes of a scene in device memory. All volumes share the images, each with its own box. volume/upload_volumes.h
/// fills the images, volume/volume_field.glsl reads them. Lengths are in voxels, so a scaled placement keeps the
/// optical depth across its volume. An image of a property that no volume has is one texel of zeros.
struct VolumeImages {
    GpuImage index;           ///< RGBA32F: index of four voxels along x, the second is the texel's own
    GpuImage bricks;          ///< RG32F per 8^3 cells. r: index if uniform, else 0; g: 1 if the media are uniform
    GpuImage absorption;      ///< RGBA16F: sigma_a per voxel; a: boundary
    GpuImage scattering;      ///< RGBA16F: sigma_s per voxel; a: g
    GpuImage emission;        ///< RGBA16F: radiance added over a voxel's length
    Buffer records;           ///< VolumeRecord per placement, boxes of less content first
    std::uint32_t count = 0;  ///< placements
    bool absorbs = false, scatters = false, emits = false, reflects = false, disperses = false;
    bool overlapping = false;  ///< boxes of two placements may overlap
};

}  // namespace pellucid
