#pragma once

#include "scene/gltf_file.h"
#include "scene/rig.h"

#include <pellucid/scene.h>

#include <vector>

namespace pellucid {

/// All animations of a glTF file. Ignores channels with unsupported targets, with a warning. Throws Error for invalid
/// keyframes: types or counts that the specification forbids, decreasing times, numbers that are not finite, rotations
/// of length zero.
std::vector<Animation> read_gltf_animations(const GltfFile& gltf, const NodeTree& tree, Warnings& warnings);

/// Number of morph target weights of a mesh in the file.
std::size_t morph_target_count(const tinygltf::Mesh& mesh);

/// The animation selected by the options; null for none. Throws Error listing the known animations.
const Animation* chosen_animation(const GltfFile& gltf, const std::vector<Animation>& animations,
                                  const LoadOptions& options);

}  // namespace pellucid
