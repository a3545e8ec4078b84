#pragma once

#include <pellucid/scene.h>

#include <string>

namespace pellucid {

/// Makes a procedural shape. `spec` is `NAME[,PARAMETER=VALUE...]`; names, parameters, defaults and
/// ranges are in shape_infos(). Every shape is closed (each edge belongs to exactly two triangles
/// once vertices of equal position are merged), counter-clockwise seen from outside, and about 1 m
/// in radius around the origin, +Y up.
/// Throws Error in one line for an unknown name or parameter, listing the known ones, and for a
/// value that is malformed, out of range, or does not go with the others.
Mesh load_shape(const std::string& spec);

}  // namespace pellucid
