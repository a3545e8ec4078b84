#pragma once

#include <pellucid/scene.h>

#include <cstdint>
#include <vector>

namespace pellucid {

/// For each welded vertex the angle (radians) from which on edges of its shell are creases; pi: none is.
///
/// The bends of a shell's edges say which. Shapes with creases have gentle bends and sharp ones, with a gap between
/// them; the bends of scans and of organic models thin out without one. A gap is an interval of 15 degrees, between 25
/// and 90 degrees, which holds at most a tenth as many edges as lie above it. The edges above must be at least the
/// square root of all edges: as many as one line across the shell has. The crease angle is the middle of the lowest
/// gap.
std::vector<float> crease_angles(const Mesh& mesh, const std::vector<std::uint32_t>& weld);

}  // namespace pellucid
