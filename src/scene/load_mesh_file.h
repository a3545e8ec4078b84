#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <filesystem>

namespace pellucid {

/// Reads a mesh file (.obj .ply .stl .off .3ds). An .obj file whose material files can be read has one object per
/// material, if one of these is glass or `options` says nothing about glass. Every other file is one solid of glass,
/// named after the file, and its colours are not used.
/// Throws Error if the file is malformed or contains no triangles.
Scene load_mesh_file(const std::filesystem::path& file, const LoadOptions& options, Warnings& warnings);

}  // namespace pellucid
