#pragma once

#include "scene/far_positions.h"
#include "scene/mesh_files/polygon_file.h"

#include <pellucid/scene.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace pellucid {

/// Box of the positions that polygons use, in the file's frame. Throws Error, naming the vertex, for one that is not
/// finite or beyond 1e15.
Box used_box(const std::filesystem::path& file, const PolygonFile& content);

/// What of a polygon file becomes one mesh.
struct PartChoice {
    std::optional<std::vector<std::uint32_t>> polygons;  ///< indices into PolygonFile::ends; none: all of them
    bool texcoords = false;                              ///< keep texture coordinates
    bool colors = false;                                 ///< keep colours of vertices
    glm::dvec3 origin{0.0};                              ///< subtracted from positions
};

/// Polygons as triangles. Identical vertices are one. Normals are there if all corners have them, and not all are zero;
/// `lost_normals` says how many corners have some where others have none.
Mesh mesh_of_part(const PolygonFile& content, const PartChoice& part, std::size_t& lost_normals);

}  // namespace pellucid
