#pragma once

#include <pellucid/scene.h>

#include <string>

namespace pellucid {

/// Generates a procedural shape. `spec` is `NAME[,PARAMETER=VALUE...]`; shape_infos() lists names, parameters,
/// defaults and ranges. Every shape is closed: after merging vertices of equal position, each edge belongs to exactly
/// two triangles. Triangles are counter-clockwise seen from outside. The radius around the origin is about 1 m, with
/// +Y up. Throws Error in one line for an unknown name or parameter, listing the known ones. Also throws Error for a
/// value that is malformed, out of range, or incompatible with the others.
Mesh load_shape(const std::string& spec);

}  // namespace pellucid
