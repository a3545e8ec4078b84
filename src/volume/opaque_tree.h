#pragma once

#include "volume/light_records.h"

#include <pellucid/scene.h>

#include <vector>

namespace pellucid {

/// A hierarchy of boxes around the opaque triangles of a scene, in world space, for intersections with light
/// (opaque_tree.glsl). A node is followed by its subtree.
struct OpaqueTree {
    std::vector<gpu::OpaqueNode> nodes;
    std::vector<gpu::OpaqueTriangle> triangles;
};

/// Builds the tree from all objects that are not transmissive. Skips triangles without an area.
OpaqueTree build_opaque_tree(const Scene& scene);

}  // namespace pellucid
