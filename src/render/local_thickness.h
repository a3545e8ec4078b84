#pragma once

#include "bake/bake_cache.h"
#include "gpu/gpu_scene.h"
#include "shade/transmitted_light.h"

#include <pellucid/progress.h>
#include <pellucid/scene.h>

#include <string>
#include <vector>

namespace pellucid {

/// Bakes the local thickness of every translucent object of the scene, or finds it in the cache. Objects that are
/// stretched differently in different directions are baked as they stand. Throws Error if the device has no room.
LocalThickness bake_local_thickness(const Device& device, const Scene& scene, bake::BakeCache& cache,
                                    std::uint32_t threads, const Progress& progress,
                                    std::vector<std::string>& warnings);

}  // namespace pellucid
