#pragma once

#include "scene/gltf_file.h"

namespace pellucid {

/// Decodes all primitives of KHR_draco_mesh_compression, into accessors of their own. Data that cannot be decoded is an
/// Error, or a warning where the file holds the primitive uncompressed as well.
void decode_draco(GltfFile& gltf, Warnings& warnings);

}  // namespace pellucid
