#pragma once

#include "gpu/gpu_scene.h"
#include "shade/transmitted_light.h"

#include <pellucid/scene.h>

#include <vector>

namespace pellucid {

/// What the map of light `number` has to look at for every translucent surface of the scene, `resolution` texels along
/// a side: one view around them; or, where a point or spot light is so near that they would fill more than 120 degrees
/// of it, the faces of a cube that any of them may lie in.
std::vector<LightView> light_views(const Light& light, std::uint32_t number, const GpuScene& scene,
                                   std::uint32_t resolution);

}  // namespace pellucid
