#pragma once

#include <pellucid/progress.h>
#include <pellucid/scene.h>

#include <cstdint>
#include <vector>

namespace pellucid::bake {

/// Per vertex, ambient occlusion with the normals inverted, as a length: how far rays run inside the solid until they
/// leave it, on average over `rays` directions about the inverted normal, weighted by the cosine to it; m in the mesh's
/// own frame. Rays that find no way out (an open mesh) are left out; 0 where none does. Of a ball: 4/3 of its radius.
/// `threads` 0: all cores. Throws Error if Embree cannot build.
///
/// (Chen, "local thickness"; Barré-Brisebois & Bouchard, "Approximating Translucency for a Fast, Cheap and Convincing
/// Subsurface Scattering Look", GDC 2011.)
std::vector<float> inverted_occlusion(const Mesh& mesh, std::uint32_t rays, std::uint32_t threads = 0,
                                      const Progress& progress = {});

}  // namespace pellucid::bake
