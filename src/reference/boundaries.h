#pragma once

#include "reference/geometry.h"

#include <vector>

namespace pellucid::reference {

/// The boundary of another solid that touches `hit`, where the ray stands; found == false if there is none. Where
/// solids touch, intersection order is arbitrary. `ray` starts at the hit.
Hit touching_boundary(const Geometry& geometry, const Query& ray, const Hit& hit);

/// Moves a ray on the boundary of a solid to its other side, across all boundaries that touch there; appends these to
/// `standing`. `inside`: the solids before the boundary, corrected for open surfaces, whose normals tell the ray's
/// side. `beyond` receives the solids behind it. Returns the boundary between the two media: that of the solid that
/// displaces the other.
Hit cross_boundaries(const Geometry& geometry, const Query& ray, const Hit& hit, std::vector<Crossing>& standing,
                     MediumStack& inside, MediumStack& beyond);

}  // namespace pellucid::reference
