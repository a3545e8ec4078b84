#pragma once

#include "volume/light_records.h"

#include <pellucid/scene.h>

#include <vector>

namespace pellucid {

/// Boxes around the opaque triangles of a scene, world, in which light finds the surface that it meets
/// (opaque_tree.glsl). A node is followed by its subtree.
struct OpaqueTree {
    std::vector<gpu::OpaqueNode> nodes;
    std::vector<gpu::OpaqueTriangle> triangles;
};

/// A tree of all objects that are not transmissive. Triangles without an area are left out.
OpaqueTree build_opaque_tree(const Scene& scene);

}  // namespace pellucid
