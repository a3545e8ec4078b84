#pragma once

#include "core/memory_budget.h"
#include "scene/mesh_files/mtl_file.h"

#include <pellucid/scene.h>

namespace pellucid {

/// Whether a material is glass: illum 4, 6, 7 or 9, but for the illum 4 with a white Tf and nothing else that Maya writes
/// for everything; or d < 1 with an index of refraction Ni > 1 or a transmission
/// filter Tf; or Tf > 0 with Pr or Pm, as Blender writes transmission.
bool is_glass(const MtlMaterial& from);

/// The material as the renderer has it. Its textures are read into `scene`; what is not drawn is added to `warnings`.
Material material_from_mtl(const MtlMaterial& from, Scene& scene, MemoryBudget& memory, Warnings& warnings);

}  // namespace pellucid
