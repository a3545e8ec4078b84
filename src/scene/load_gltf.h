#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <filesystem>

namespace pellucid {

/// Loads the default scene of a glTF 2.0 file (.gltf or .glb). The caller applies LoadOptions' overrides of materials,
/// and fills Scene::source and Scene::warnings. Throws Error for violations of the glTF specification and for
/// unsupported required extensions.
Scene load_gltf(const std::filesystem::path& file, const LoadOptions& options, Warnings& warnings);

}  // namespace pellucid
