#pragma once

#include "scene/gltf_file.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid {

/// Reads an accessor as vectors of N floats. Normalized integers are scaled to 0..1 or -1..1; others keep their values
/// (KHR_mesh_quantization). Supports sparse accessors, and accessors without a buffer view (zeros). Throws Error
/// naming `user` if the accessor does not exist, has another type, or exceeds its data.
template <int N>
std::vector<glm::vec<N, float>> read_vectors(const GltfFile& gltf, int accessor, const std::string& user);

/// Reads all values of an accessor of floats or normalized integers, `components` per element; read_floats() accepts
/// floats only. Throws Error as read_vectors(), and for numbers that are not finite.
std::vector<float> read_fractions(const GltfFile& gltf, int accessor, int components, const std::string& user);
std::vector<float> read_floats(const GltfFile& gltf, int accessor, int components, const std::string& user);

/// Reads four unsigned 8 or 16 bit integers per element. Throws Error as read_vectors().
std::vector<glm::uvec4> read_joints(const GltfFile& gltf, int accessor, const std::string& user);

/// Number of components of an accessor's elements; 0 if the accessor does not exist.
int component_count(const GltfFile& gltf, int accessor);

/// Reads an accessor of unsigned 8, 16 or 32 bit integers. Throws Error as read_vectors().
std::vector<std::uint32_t> read_indices(const GltfFile& gltf, int accessor, const std::string& user);

}  // namespace pellucid
