#pragma once

#include "bake/bake_cache.h"
#include "gpu/gpu_scene.h"
#include "shade/transmitted_light.h"

#include <pellucid/progress.h>
#include <pellucid/scene.h>

#include <string>
#include <vector>

namespace pellucid {

/// Bakes the local thickness, in the form of `method`, of every translucent object of the scene, or reads it from the cache. Objects with
/// non-uniform scale are baked in world space. Throws Error if the device runs out of memory.
LocalThickness bake_local_thickness(const Device& device, const Scene& scene, ThicknessMethod method,
                                    bake::BakeCache& cache, std::uint32_t threads, const Progress& progress,
                                    std::vector<std::string>& warnings);

}  // namespace pellucid
