#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <string>
#include <vector>

namespace pellucid {

/// Changes by repair_solid() beyond its warnings.
struct SolidRepair {
    bool inside_out = false;  ///< the whole surface was reversed, normals included
};

/// Repairs the surface of a solid from a file, so that it defines an inside, and warns of every change and remaining
/// defect. Merges nearly coincident vertices. Removes duplicate triangles. Reverses triangles wound against their
/// neighbours, and shells wound inside out (orient_shells.h). Removes triangles without area. Normals are updated
/// accordingly. `deforms`: vertices and normals stay unchanged, except for a reversal of the whole surface.
SolidRepair repair_solid(Mesh& mesh, bool deforms, Warnings& warnings);

/// Repairs parts that together bound one solid. `name`: name of the solid, for warnings.
void repair_solid_in_parts(const std::vector<Mesh*>& parts, const std::string& name, Warnings& warnings);

}  // namespace pellucid
