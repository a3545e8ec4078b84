#pragma once

#include "reference/geometry.h"

#include <vector>

namespace pellucid::reference {

/// The boundary of another solid at the very place of `hit`, on which the ray stands; found == false if there
/// is none. Where solids touch, the order in which their surfaces are found is chance. `ray` starts at the hit.
Hit touching_boundary(const Geometry& geometry, const Query& ray, const Hit& hit);

/// Takes a ray that stands on the boundary of a solid to its other side: past that one and those of others
/// that touch it there, which `standing` then holds, too. `inside` are the solids before it (corrected for
/// surfaces that are not closed, whose normals say where the ray is), `beyond` becomes those behind it.
/// Returns the boundary between the two media: that of the solid that displaces the other.
Hit cross_boundaries(const Geometry& geometry, const Query& ray, const Hit& hit, std::vector<Crossing>& standing,
                     MediumStack& inside, MediumStack& beyond);

}  // namespace pellucid::reference
