#pragma once

#include "scene/mesh_files/polygon_file.h"
#include "scene/warnings.h"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace pellucid {

// Readers of the mesh formats, from the bytes of `file`. They throw Error naming the file, the element or line, and
// what is wrong with it. What they leave out is added to `warnings`.

PolygonFile read_obj(const std::filesystem::path& file, std::vector<std::byte> bytes, Warnings& warnings);
PolygonFile read_ply(const std::filesystem::path& file, std::vector<std::byte> bytes, Warnings& warnings);
PolygonFile read_stl(const std::filesystem::path& file, std::vector<std::byte> bytes, Warnings& warnings);
PolygonFile read_off(const std::filesystem::path& file, std::vector<std::byte> bytes, Warnings& warnings);
PolygonFile read_3ds(const std::filesystem::path& file, const std::vector<std::byte>& bytes, Warnings& warnings);

}  // namespace pellucid
