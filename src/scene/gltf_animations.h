#pragma once

#include "scene/gltf_file.h"
#include "scene/rig.h"

#include <pellucid/scene.h>

#include <vector>

namespace pellucid {

/// All animations of a glTF file. Channels that drive nothing that is read are left out with a warning. Throws
/// Error for keyframes that cannot be: other types or counts than the specification asks for, times that go
/// back, numbers that are not finite, rotations of length zero.
std::vector<Animation> read_gltf_animations(const GltfFile& gltf, const NodeTree& tree, Warnings& warnings);

/// How many weights the morph targets of a mesh of the file have.
std::size_t morph_target_count(const tinygltf::Mesh& mesh);

/// The animation that the options ask for, null for none. Throws Error listing those that there are.
const Animation* chosen_animation(const GltfFile& gltf, const std::vector<Animation>& animations,
                                  const LoadOptions& options);

}  // namespace pellucid
