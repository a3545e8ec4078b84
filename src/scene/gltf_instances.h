#pragma once

#include "scene/gltf_file.h"

#include <glm/glm.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// Instances in a scene. Shared accessors could otherwise make any number of them from a small file.
inline constexpr std::size_t kMostInstances = std::size_t(1) << 20;

/// Transforms from the mesh to the node of its instances (EXT_mesh_gpu_instancing); nothing if the node has none of
/// these. Throws Error that begins with `user`, also for more than `most` instances.
std::optional<std::vector<glm::dmat4>> gltf_instances(const GltfFile& gltf, int node, const std::string& user,
                                                      std::size_t most, Warnings& warnings);

}  // namespace pellucid
