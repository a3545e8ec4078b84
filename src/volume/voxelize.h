#pragma once

#include <pellucid/voxelize.h>

namespace pellucid {

class Device;

/// See pellucid/voxelize.h. Uses an existing device.
VoxelizedScene voxelize(const Device& device, const Scene& scene, const VoxelSettings& settings);

}  // namespace pellucid
