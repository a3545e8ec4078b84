#pragma once

#include <pellucid/scene.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace pellucid {

/// What orient_shells() found and did.
struct ShellOrientation {
    std::size_t shells = 0;  ///< connected surfaces of the mesh
    std::size_t turned = 0;  ///< of these, shells that were wound inside out
    bool all_closed = true;  ///< every edge of the mesh has as many triangles on the one side as on the other
};

/// Turns every closed shell that is wound inside out, so that its triangles are counter-clockwise seen from outside.
///
/// A shell is a set of triangles joined over welded edges. A shell that is wound inwards stays as it is where it is a
/// cavity: where the other shells enclose all of it. Shells that cross each other are judged by their own signed volume
/// alone. Open shells are left alone. `weld` has one entry per position (weld_positions()).
ShellOrientation orient_shells(Mesh& mesh, std::span<const std::uint32_t> weld);

}  // namespace pellucid
