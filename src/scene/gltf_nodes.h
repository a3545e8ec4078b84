#pragma once

#include "scene/gltf_file.h"
#include "scene/rig.h"

#include <cstddef>
#include <string>
#include <vector>

namespace pellucid {

/// The node trees of a glTF file.
struct GltfNodes {
    NodeTree tree;
    std::size_t in_scene = 0;  ///< the first ones of tree.order are the default scene's, each before its children
    std::vector<char> hidden;  ///< by node: KHR_node_visibility hides it, itself or through its ancestors
};

/// Throws Error for transforms that cannot be, and for nodes of the default scene that are their own ancestors or
/// have two parents. Other nodes, which joints of skins may be, are placed where they can be.
GltfNodes read_gltf_nodes(const GltfFile& gltf);

/// What messages call a node.
std::string gltf_node_name(const GltfFile& gltf, int node);

}  // namespace pellucid
