#pragma once

#include <pellucid/progress.h>
#include <pellucid/scene.h>

#include <cstdint>
#include <vector>

namespace pellucid::bake {

/// Per vertex, how far a ray runs from it against its normal until it leaves the solid, m in the mesh's own frame;
/// 0 where it finds no way out (an open mesh, or one whose triangles face inwards). Surfaces that the ray would
/// enter the solid by once more are passed through. `threads` 0: all cores. Throws Error if Embree cannot build.
///
/// (Wyman 2005, "An Approximate Image-Space Approach for Interactive Refraction", section 3.1: d_N.)
std::vector<float> inward_distances(const Mesh& mesh, std::uint32_t threads = 0, const Progress& progress = {});

}  // namespace pellucid::bake
