#pragma once

#include <pellucid/mesh.h>

#include <cstddef>

namespace pellucid {

/// Normalises all normals. Replaces zero and non-finite normals by generated ones (without creases); returns their
/// count.
std::size_t make_normals_valid(Mesh& mesh);

}  // namespace pellucid
