#pragma once

#include "core/memory_budget.h"
#include "scene/mesh_files/mtl_file.h"
#include "scene/mesh_files/polygon_file.h"

#include <pellucid/scene.h>

#include <filesystem>
#include <optional>
#include <vector>

namespace pellucid {

/// Materials of an OBJ file's libraries, one per PolygonFile::material_names, and one more for polygons that name none.
/// Empty: the file has none that could be read, and is glass as a whole. What is missing is added to `warnings`.
/// Throws Error for a library outside the file's folder, unless that is allowed.
std::vector<MtlMaterial> read_obj_materials(const std::filesystem::path& file, const PolygonFile& content,
                                            bool allow_outside, Warnings& warnings);

/// One object per material, named after it. Its glass is solid, or thin-walled where a surface is so open that it has
/// no inside. `origin` is subtracted from positions.
Scene obj_scene(const std::filesystem::path& file, const PolygonFile& content,
                const std::vector<MtlMaterial>& materials, const glm::dvec3& origin, const LoadOptions& options,
                MemoryBudget& memory, Warnings& warnings);

}  // namespace pellucid
