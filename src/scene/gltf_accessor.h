#pragma once

#include "scene/gltf_file.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid {

/// Reads an accessor as vectors of N floats. Integers are scaled to 0..1 or -1..1 if the accessor
/// is normalized and kept as they are otherwise (KHR_mesh_quantization). Sparse accessors and
/// accessors without a buffer view (zeros) are understood.
/// Throws Error that says `user` if the accessor does not exist, is of another type, or reaches
/// beyond its data.
template <int N>
std::vector<glm::vec<N, float>> read_vectors(const GltfFile& gltf, int accessor, const std::string& user);

/// All values of an accessor of floats or normalized integers, `components` for each element; read_floats() takes
/// floats alone. Throws Error as above, and for numbers that are not finite.
std::vector<float> read_fractions(const GltfFile& gltf, int accessor, int components, const std::string& user);
std::vector<float> read_floats(const GltfFile& gltf, int accessor, int components, const std::string& user);

/// Reads four unsigned 8 or 16 bit integers per element. Throws Error as above.
std::vector<glm::uvec4> read_joints(const GltfFile& gltf, int accessor, const std::string& user);

/// Number of components of an accessor's elements, 0 if there is no such accessor.
int component_count(const GltfFile& gltf, int accessor);

/// Reads an accessor of unsigned 8, 16 or 32 bit integers. Throws Error as above.
std::vector<std::uint32_t> read_indices(const GltfFile& gltf, int accessor, const std::string& user);

}  // namespace pellucid
