#pragma once

#include "volume/light_records.h"
#include "volume/volume_records.h"

#include <pellucid/scene.h>

#include <span>
#include <vector>

namespace pellucid {

struct FrontOptions {
    float side = 0.95f;          ///< of a patch where it comes to its volume, voxels of that
    std::uint32_t most_patches;  ///< of all fronts together
    bool per_color = false;      ///< a front for each colour, as the index of some volume differs
};

struct LightFronts {
    std::vector<gpu::LightFront> fronts;
    double most_power = 0.0;  ///< no colour emits more, W
    bool coarsened = false;   ///< for want of room patches are larger than `side`
};

/// Fronts of all lights towards all volumes. A directional light begins in a plane before all volumes; a point light seen
/// from outside covers the sphere around a box, or else all directions. The range of a light does not end it here.
LightFronts make_fronts(std::span<const Light> lights, std::span<const VolumeRecord> volumes,
                        const FrontOptions& options);

}  // namespace pellucid
