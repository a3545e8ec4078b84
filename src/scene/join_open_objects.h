#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <vector>

namespace pellucid {

/// Joins refracting objects of equal media into one body if their open surfaces close each other, such as the faces of
/// a cube in two nodes. A warning about the join replaces the warnings about open surfaces. The joined objects get new
/// meshes in the frame of the first. `moves`: per object, whether it may move independently; such objects are not
/// joined.
void join_open_objects(Scene& scene, const std::vector<char>& moves, Warnings& warnings);

}  // namespace pellucid
