#pragma once

#include "scene/gltf_file.h"

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cstddef>
#include <map>
#include <string>

namespace pellucid {

/// Volumes that nodes of a glTF file name in `extras`: `"pellucid_volume": "volume:NAME[,...]"`, or a .vdb file by its
/// path from the file's folder. Nodes with the same one share it.
class GltfVolumes {
public:
    GltfVolumes(const GltfFile& gltf, Scene& scene) : gltf_(gltf), scene_(scene) {}

    /// Places the node's volume, if it has one, in the node's frame. It stands for the refracting ones among the
    /// scene's objects from `first_object` on, those of the node. Throws Error naming the node.
    void add(const tinygltf::Node& node, const std::string& node_name, const glm::dmat4& world_from_node,
             std::size_t first_object);

private:
    const GltfFile& gltf_;
    Scene& scene_;
    std::map<std::string, int> volumes_;  ///< indices into Scene::volumes
};

}  // namespace pellucid
