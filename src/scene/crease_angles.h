#pragma once

#include <pellucid/scene.h>

#include <cstdint>
#include <vector>

namespace pellucid {

/// Crease angle of each welded vertex, radians: edges of its shell with at least this angle are creases. pi: no
/// creases.
///
/// The distribution of a shell's edge angles determines the crease angle. Shapes with creases have gentle and sharp
/// edges with a gap between them. Scans and organic models have no gap. A gap is an interval of 15 degrees, between 25
/// and 90 degrees. It contains at most a tenth as many edges as lie above it. The edges above it must number at least
/// the square root of all edges, about as many as one line across the shell. The crease angle is the middle of the
/// lowest gap.
std::vector<float> crease_angles(const Mesh& mesh, const std::vector<std::uint32_t>& weld);

}  // namespace pellucid
