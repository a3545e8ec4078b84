#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <filesystem>

namespace pellucid {

/// Reads a mesh file (.obj .ply .stl .off .3ds) as one mesh, named after the file: all its parts,
/// placed as the file says. Normals are there if every part brings them. Identical vertices are
/// one. Materials, textures and colours of the file are not read; nor is any other file.
/// Throws Error if the file is malformed or contains no triangles.
Mesh load_mesh_file(const std::filesystem::path& file, Warnings& warnings);

}  // namespace pellucid
