#pragma once

#include "core/file_scope.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace pellucid {

/// "%20" and the like as the characters that they stand for.
std::string percent_decoded(const std::string& uri);

/// The file that a URI names, relative to the folder of `scope`. Throws Error if it is not there, is no regular file,
/// or is outside.
std::filesystem::path gltf_uri_file(const FileScope& scope, const std::string& uri);

/// Content of a data URI, or of such a file. Throws Error.
std::vector<std::byte> read_gltf_uri(const FileScope& scope, const std::string& uri);

}  // namespace pellucid
