#pragma once

#include <pellucid/progress.h>
#include <pellucid/scene.h>

#include <cstdint>
#include <vector>

namespace pellucid::bake {

/// Per vertex, ambient occlusion with inverted normals, as a length. The result is the mean distance that rays travel
/// inside the solid, m in the mesh's own frame. The mean is over `rays` directions about the inverted normal, weighted
/// by their cosine. Rays that never leave the solid (open mesh) do not count; 0 if none leaves it. For a ball the
/// result is 4/3 of its radius. `threads`: 0 for all cores. Throws Error if Embree cannot build.
///
/// (Chen, "local thickness"; Barré-Brisebois & Bouchard, "Approximating Translucency for a Fast, Cheap and Convincing
/// Subsurface Scattering Look", GDC 2011.)
std::vector<float> inverted_occlusion(const Mesh& mesh, std::uint32_t rays, std::uint32_t threads = 0,
                                      const Progress& progress = {});

/// The published form: the share of the samples in a half ball about the inverted normal that lie inside the solid,
/// weighted as above. The radius of the ball is half the diagonal of the mesh's box. The result is the share times this
/// radius, because the text gives no unit.
std::vector<float> inside_share(const Mesh& mesh, std::uint32_t rays, std::uint32_t threads = 0,
                                const Progress& progress = {});

}  // namespace pellucid::bake
