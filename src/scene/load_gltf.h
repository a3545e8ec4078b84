#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <filesystem>

namespace pellucid {

/// Loads the default scene of a glTF 2.0 file (.gltf or .glb). LoadOptions' overrides of materials
/// are applied by the caller; Scene::source and Scene::warnings are left empty.
/// Throws Error for what the glTF specification forbids and for required extensions that are not
/// supported.
Scene load_gltf(const std::filesystem::path& file, const LoadOptions& options, Warnings& warnings);

}  // namespace pellucid
