#pragma once

#include "scene/pose_nodes.h"
#include "scene/rig.h"

#include <glm/glm.hpp>

#include <vector>

namespace pellucid {

/// Vertices of one mesh in a pose, with unit normals.
struct DeformedVertices {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    bool finite() const;  ///< false if positions overflowed
};

/// Applies morph targets, then the skin. Positions are in the shape's own frame, or with a skin in world space.
DeformedVertices deform(const Rig& rig, const DeformedMesh& mesh, const NodePose& pose);

/// True if the skin in this pose mirrors most of the vertices.
bool skin_mirrors(const Rig& rig, const DeformedMesh& mesh, const NodePose& pose);

}  // namespace pellucid
