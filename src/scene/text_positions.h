#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace pellucid {

/// Reads the vertex positions of a mesh file in double precision, where its format has them as text or as 64-bit
/// numbers. Where they lie far from 0, subtracts their frame_origin() from them in `bytes` and returns it; 0
/// otherwise. Also removes the w of positions `x y z w` of .obj files: a weight for rational curves, by which
/// positions are not divided.
///
/// `bytes` must have passed check_mesh_file(). Files whose positions are not understood here are left as they are.
glm::dvec3 rebase_stored_positions(const std::string& extension, std::vector<std::byte>& bytes);

}  // namespace pellucid
