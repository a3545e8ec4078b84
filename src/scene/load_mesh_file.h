#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <filesystem>

namespace pellucid {

/// A mesh, and where the origin of its frame lies in the file's (see Scene::origin).
struct MeshFile {
    Mesh mesh;
    glm::dvec3 origin{0.0};
};

/// Reads a mesh file (.obj .ply .stl .off .3ds) as one mesh, named after the file: all its parts,
/// placed as the file says. Normals are there if every part brings them, and not all are zero. Identical
/// vertices are one. Materials, textures and colours of the file are not read; nor is any other file.
/// Throws Error if the file is malformed or contains no triangles.
MeshFile load_mesh_file(const std::filesystem::path& file, Warnings& warnings);

}  // namespace pellucid
