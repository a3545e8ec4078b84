#pragma once

#include "scene/gltf_file.h"

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <string>

namespace pellucid {

/// Adds the light that a node carries, if any, to scene.lights (KHR_lights_punctual). `node_name` stands
/// for the node in messages and for a light without a name. The node's scale has no effect on a light.
/// The extension is photometric (candela, lux); its numbers are taken as radiometric ones (W/sr, W/m2),
/// which differ from them by one factor for a whole scene.
/// Throws Error if the node names a light that is not there. Numbers out of range are brought into it
/// with a warning.
void add_gltf_light(const GltfFile& gltf, const tinygltf::Node& node, const std::string& node_name,
                    const glm::dmat4& world_from_node, Scene& scene, Warnings& warnings);

}  // namespace pellucid
