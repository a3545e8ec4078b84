#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// Checks the bytes of a mesh file (extension in lower case, with dot) for what assimp takes on
/// trust: counts that the file is too short for, and indices that point nowhere. Such counts end in
/// gigabytes of memory, such indices in a crash or in a silently different shape.
/// Also rewrites, in `bytes`, what formats allow but assimp does not read.
/// Returns the number of polygons that the file announces, if its format does.
/// Throws Error naming `file`.
std::optional<std::uint64_t> check_mesh_file(const std::filesystem::path& file, const std::string& extension,
                                             std::vector<std::byte>& bytes);

/// The same for one format each, where that is more than a few lines.
void check_obj(const std::filesystem::path& file, std::vector<std::byte>& bytes);
std::uint64_t check_ply(const std::filesystem::path& file, std::vector<std::byte>& bytes);

}  // namespace pellucid
