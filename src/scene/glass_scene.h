#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

namespace pellucid {

/// A scene of one solid made of glass. `keep_normals`: those that the mesh has.
Scene glass_scene(Mesh mesh, const LoadOptions& options, bool keep_normals, Warnings& warnings);

}  // namespace pellucid
