#pragma once

#include "scene/pose_nodes.h"
#include "scene/rig.h"

#include <glm/glm.hpp>

#include <vector>

namespace pellucid {

/// Vertices of one mesh in a pose: normals unit.
struct DeformedVertices {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    bool finite() const;  ///< false if numbers of the file became too large
};

/// Morphs, then skins. Positions are in the shape's own frame, or in the world's with a skin.
DeformedVertices deform(const Rig& rig, const DeformedMesh& mesh, const NodePose& pose);

/// True if the skin, in this pose, mirrors most of the vertices.
bool skin_mirrors(const Rig& rig, const DeformedMesh& mesh, const NodePose& pose);

}  // namespace pellucid
