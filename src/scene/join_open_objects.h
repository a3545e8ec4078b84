#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <vector>

namespace pellucid {

/// Refracting objects of equal media whose open surfaces close each other, such as the faces of a cube in two nodes,
/// become one body, with a warning that takes the place of those that they are open. They get meshes of their own, in the
/// frame of the first. `moves`: per object, whether it may be moved apart later; such are left alone.
void join_open_objects(Scene& scene, const std::vector<char>& moves, Warnings& warnings);

}  // namespace pellucid
