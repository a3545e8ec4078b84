#pragma once

#include <pellucid/voxelize.h>

namespace pellucid {

class Device;

/// See pellucid/voxelize.h; on a device that is there.
VoxelizedScene voxelize(const Device& device, const Scene& scene, const VoxelSettings& settings);

}  // namespace pellucid
