#pragma once

#include "scene/gltf_file.h"

namespace pellucid {

/// Decodes all buffer views of EXT_meshopt_compression and KHR_meshopt_compression, into buffers of their own.
/// Throws Error for damaged data.
void decode_meshopt(GltfFile& gltf);

}  // namespace pellucid
