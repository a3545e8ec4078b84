#pragma once

#include "gpu/workspace.h"

#include <pellucid/scene.h>

#include <cstdint>
#include <vector>

namespace pellucid {

/// The share of every voxel of `grid` that lies in a solid, 0..1. Only size, low and voxel of `grid` are used.
/// Overlapping shells count as one solid; a shell that is inside out cuts a hole. `samples`: columns along x and y of a
/// voxel, 1..16. Triangles must lie inside the grid. If a column enters a solid more often than it leaves, the open
/// part is outside.
std::vector<float> mesh_coverage(Workspace& workspace, const Volume& grid, const Mesh& mesh,
                                 const glm::mat4& grid_from_mesh, std::uint32_t samples);

}  // namespace pellucid
