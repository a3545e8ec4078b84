#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <string>
#include <vector>

namespace pellucid {

/// What repair_solid() did besides what it warned about.
struct SolidRepair {
    bool inside_out = false;  ///< the whole surface was turned, normals and all
};

/// Makes the surface of a solid from a file one that says where inside is, and warns of what it changed or could not:
/// vertices that all but touch are joined, triangles that are there twice go, triangles wound against their neighbours
/// and shells wound inside out are turned (orient_shells.h), triangles without area go. Normals, where there are any,
/// follow. `deforms`: vertices and normals stay as they are, but for turning the whole surface.
SolidRepair repair_solid(Mesh& mesh, bool deforms, Warnings& warnings);

/// The same for parts that bound one solid together; `name` is the solid's, for warnings.
void repair_solid_in_parts(const std::vector<Mesh*>& parts, const std::string& name, Warnings& warnings);

}  // namespace pellucid
