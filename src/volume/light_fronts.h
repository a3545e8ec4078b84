#pragma once

#include "volume/light_records.h"
#include "volume/volume_records.h"

#include <pellucid/scene.h>

#include <span>
#include <vector>

namespace pellucid {

struct FrontOptions {
    float side = 0.95f;          ///< side of a patch where it reaches its volume, voxels
    std::uint32_t most_patches;  ///< most patches of all fronts together
    bool per_color = false;      ///< emit a front per colour, because a volume disperses
};

struct LightFronts {
    std::vector<gpu::LightFront> fronts;
    double most_power = 0.0;  ///< upper bound of the emitted power per colour, W
    bool coarsened = false;   ///< patches are larger than `side`, because `most_patches` is too low
};

/// Generates the fronts of all lights towards all volumes. A directional light begins in a plane in front of all
/// volumes. A point light covers the sphere around a box; if it is near or inside, it covers all directions.
/// Light::range is ignored.
LightFronts make_fronts(std::span<const Light> lights, std::span<const VolumeRecord> volumes,
                        const FrontOptions& options);

}  // namespace pellucid
