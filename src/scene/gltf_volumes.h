#pragma once

#include "scene/gltf_file.h"

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cstddef>
#include <map>
#include <string>

namespace pellucid {

/// Volumes named in `extras` of a glTF file's nodes: `"pellucid_volume": "volume:NAME[,...]"`, or the path of a .vdb
/// file relative to the file's folder. Nodes with the same name share a volume.
class GltfVolumes {
public:
    GltfVolumes(const GltfFile& gltf, Scene& scene) : gltf_(gltf), scene_(scene) {}

    /// Places the node's volume, if any, in the node's frame. It is assigned to the node's refracting objects, which
    /// are those from `first_object` on. Throws Error naming the node.
    void add(const tinygltf::Node& node, const std::string& node_name, const glm::dmat4& world_from_node,
             std::size_t first_object);

private:
    const GltfFile& gltf_;
    Scene& scene_;
    std::map<std::string, int> volumes_;  ///< indices into Scene::volumes, keyed by name
};

}  // namespace pellucid
