#pragma once

#include "scene/warnings.h"

#include "scene/tinygltf.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace pellucid {

/// Bytes of an image that a glTF file names; not decoded, since most images are never needed.
struct GltfImage {
    std::string name;
    std::vector<std::byte> bytes;
    std::string problem;  ///< why there are no bytes; empty if there are
};

/// A glTF file with everything that belongs to it. tinygltf's model holds the JSON part only:
/// buffers and images are read here, where sizes are checked.
struct GltfFile {
    std::filesystem::path path;
    tinygltf::Model model;  ///< its buffers and images are empty
    std::vector<std::vector<std::byte>> buffers;
    std::vector<GltfImage> images;

    /// Bytes of a buffer view. Throws Error that begins with `user` if it is out of range.
    std::span<const std::byte> view(int buffer_view, const std::string& user) const;
};

/// Throws Error for a damaged file, for missing buffers, and for required extensions that are not
/// supported. Extensions that are only used, and images that are missing, give a warning.
GltfFile read_gltf_file(const std::filesystem::path& path, Warnings& warnings);

}  // namespace pellucid
