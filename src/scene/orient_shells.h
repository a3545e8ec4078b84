#pragma once

#include "scene/shells.h"

#include <pellucid/scene.h>

#include <cstddef>

namespace pellucid {

/// What orient_shells() turned.
struct TurnedShells {
    std::size_t closed = 0;  ///< shells
    bool open = false;       ///< all that are open
};

/// Turns every closed shell that is wound inside out, so that its triangles are counter-clockwise seen from outside.
///
/// A shell that is wound inwards stays as it is where it is a cavity: where the other shells enclose all of it. Shells
/// that cross each other are judged by their own signed volume alone. Open shells are judged together, and left alone
/// where their volume has no sign that could be believed. Normals follow, but for vertices that are shared with triangles
/// of other shells.
TurnedShells orient_shells(Mesh& mesh, const Shells& shells);

/// How often a triangle, seen from the origin, surrounds it: its solid angle over 4 pi, positive where it is
/// counter-clockwise seen from outside. Van Oosterom & Strackee, "The solid angle of a plane triangle", IEEE Transactions
/// on Biomedical Engineering 30(2), 1983.
double winding_number(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

}  // namespace pellucid
