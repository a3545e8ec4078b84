#pragma once

#include "volume/light_records.h"

#include <pellucid/scene.h>

#include <string>
#include <vector>

namespace pellucid {

/// The planar opaque objects of a scene as receivers of light: each a rectangle, along the edges of its triangles, around
/// the object as far as it lies within `reach` around `center` (world, m), with square texels of edge `texel` (m) or, where
/// that makes more than `most_texels` along a side, larger ones. `gpu::LightReceiver::normal.w` counts texels from 0 on
/// over all receivers. What is transmissive, bent, or beyond reach is none.
std::vector<gpu::LightReceiver> find_receivers(const Scene& scene, glm::vec3 center, float reach, float texel,
                                               std::uint32_t most_texels);

/// Texels of all receivers together.
std::uint32_t texel_count(const std::vector<gpu::LightReceiver>& receivers);

}  // namespace pellucid
