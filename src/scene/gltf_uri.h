#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace pellucid {

/// "%20" and the like as the characters that they stand for.
std::string percent_decoded(const std::string& uri);

/// The file beside the glTF file at `path` that a URI names. Throws Error if it is not there, or is
/// no regular file.
std::filesystem::path gltf_uri_file(const std::filesystem::path& path, const std::string& uri);

/// Content of a data URI, or of a file beside the glTF file at `path`. Throws Error.
std::vector<std::byte> read_gltf_uri(const std::filesystem::path& path, const std::string& uri);

}  // namespace pellucid
