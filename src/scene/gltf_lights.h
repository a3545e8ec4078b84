#pragma once

#include "scene/gltf_file.h"

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <string>

namespace pellucid {

/// Adds the light of a node, if any, to scene.lights (KHR_lights_punctual). `node_name` names the node in messages,
/// and a light without a name. The node's scale does not affect the light.
/// The extension is photometric (candela, lux). Its numbers are read as radiometric (W/sr, W/m2), which changes a
/// scene by a constant factor.
/// Throws Error if the node's light does not exist. Numbers out of range are clamped with a warning.
void add_gltf_light(const GltfFile& gltf, const tinygltf::Node& node, const std::string& node_name,
                    const glm::dmat4& world_from_node, Scene& scene, Warnings& warnings);

}  // namespace pellucid
