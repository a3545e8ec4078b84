#pragma once

#include <pellucid/progress.h>
#include <pellucid/scene.h>

#include <cstdint>
#include <vector>

namespace pellucid::bake {

/// Per vertex, the distance that a ray against its normal travels until it leaves the solid, m in the mesh's own frame;
/// 0 if it never leaves it (open mesh, or triangles that face inwards). The ray ignores surfaces at which it would
/// enter the solid. `threads`: 0 for all cores. Throws Error if Embree cannot build.
///
/// (Wyman 2005, "An Approximate Image-Space Approach for Interactive Refraction", section 3.1: d_N.)
std::vector<float> inward_distances(const Mesh& mesh, std::uint32_t threads = 0, const Progress& progress = {});

}  // namespace pellucid::bake
