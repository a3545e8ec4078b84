#pragma once

#include "scene/gltf_file.h"

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// Transforms from the mesh to the node of its instances (EXT_mesh_gpu_instancing); nothing if the node has none of
/// these. Throws Error that begins with `user`.
std::optional<std::vector<glm::dmat4>> gltf_instances(const GltfFile& gltf, int node, const std::string& user,
                                                      Warnings& warnings);

}  // namespace pellucid
