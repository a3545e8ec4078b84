#pragma once

#include "scene/shells.h"

#include <pellucid/scene.h>

#include <cstddef>

namespace pellucid {

/// Shells reversed by orient_shells().
struct TurnedShells {
    std::size_t closed = 0;  ///< number of closed shells
    bool open = false;       ///< true if the open shells were reversed
};

/// Reverses every closed shell that is wound inside out, so that its triangles are counter-clockwise seen from
/// outside.
///
/// An inward shell stays if it is a cavity, enclosed entirely by the other shells. Shells that cross each other are
/// judged by their own signed volume alone. Open shells are judged together, and stay if their volume has no
/// meaningful sign. Normals are reversed too, except at vertices shared with other shells.
TurnedShells orient_shells(Mesh& mesh, const Shells& shells);

/// Winding number of a triangle around the origin: its solid angle over 4 pi, positive if counter-clockwise seen from
/// outside. Van Oosterom & Strackee, "The solid angle of a plane triangle", IEEE Transactions on Biomedical
/// Engineering 30(2), 1983.
double winding_number(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

}  // namespace pellucid
