#pragma once

#include "core/file_scope.h"
#include "core/memory_budget.h"
#include "scene/warnings.h"

#include "scene/tinygltf.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace pellucid {

/// An image that a glTF file names; not read yet, since most images are never needed.
struct GltfImage {
    std::string name;
    std::filesystem::path file;       ///< that it is; else
    std::vector<std::byte> bytes;     ///< of a data URI; else
    std::span<const std::byte> view;  ///< in GltfFile::buffers
    std::string problem;              ///< why there is none of these; empty if there is

    bool is_ktx2() const;
};

/// A glTF file with everything that belongs to it. tinygltf's model holds the JSON part only:
/// buffers and images are read here, where sizes are checked. Compressed meshes are decoded.
struct GltfFile {
    explicit GltfFile(const std::filesystem::path& file, bool allow_outside = false)
        : path(file), scope{file.parent_path(), allow_outside}, memory(file) {}

    std::filesystem::path path;
    FileScope scope;
    mutable MemoryBudget memory;
    tinygltf::Model model;  ///< its buffers and images are empty; views and accessors may follow those of the file
    std::vector<std::vector<std::byte>> buffers;
    std::vector<GltfImage> images;

    /// Bytes of a buffer view. Throws Error that begins with `user` if it is out of range.
    std::span<const std::byte> view(int buffer_view, const std::string& user) const;
};

/// Reads the content of `gltf.path`. Throws Error for a damaged file, for missing buffers, and for required extensions
/// that are refused. Extensions that are left out, and images that are missing, give a warning.
void read_gltf_file(GltfFile& gltf, Warnings& warnings);

}  // namespace pellucid
