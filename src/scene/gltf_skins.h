#pragma once

#include "scene/gltf_file.h"
#include "scene/rig.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid {

/// Reads a skin of the file. Throws Error if a joint is no node of a tree, or a matrix is not affine and finite.
Skin read_gltf_skin(const GltfFile& gltf, int skin, const NodeTree& tree);

/// Joints and weights of `vertices` vertices, from all sets; empty if the primitive has none. Weights are normalised
/// to the sum 1, with a warning if they were far from it. Throws Error for weights that are not finite.
Influences read_gltf_influences(const GltfFile& gltf, const tinygltf::Primitive& primitive, std::size_t vertices,
                                const std::string& user, Warnings& warnings);

/// Throws Error if a vertex uses a joint that the skin does not have.
void check_influences(const GltfFile& gltf, const Influences& influences, std::size_t joints, const std::string& user);

/// Morph targets of `vertices` vertices. Unusable displacements are ignored with a warning.
std::vector<MorphTarget> read_gltf_targets(const GltfFile& gltf, const tinygltf::Primitive& primitive,
                                           std::size_t vertices, const std::string& user, Warnings& warnings);

/// Reorders vertices: vertex i becomes the old vertex source[i].
void gather_influences(Influences& influences, const std::vector<std::uint32_t>& source);
void gather_targets(std::vector<MorphTarget>& targets, const std::vector<std::uint32_t>& source);

}  // namespace pellucid
