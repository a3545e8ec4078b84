#pragma once

#include "scene/rig.h"

#include <map>
#include <vector>

namespace pellucid {

/// Where all nodes are at one time.
struct NodePose {
    std::vector<glm::dmat4> world_from_node;    ///< one per node; identity for those that are not placed
    std::map<int, std::vector<float>> weights;  ///< of morph targets, by node, where they are animated
};

/// No animation: the nodes at rest.
NodePose pose_nodes(const NodeTree& tree, const Animation* animation, double time_s);

/// Changes the world's frame to one whose origin lies at `origin` (world, m).
void rebase(NodePose& pose, const glm::dvec3& origin);

/// From the file's mesh to the world, in a pose.
glm::dmat4 world_from_mesh(const NodePose& pose, const NodeObject& object);

/// An object's transform in a pose, rounded once.
glm::mat4 world_from_object(const NodePose& pose, const NodeObject& object);

/// For each node whether an animation moves it, itself or through its ancestors.
std::vector<char> moved_nodes(const NodeTree& tree, const Animation& animation);

/// Whether an animation moves a mesh's vertices.
bool moves(const Rig& rig, const Animation& animation, const std::vector<char>& moved, const DeformedMesh& mesh);

}  // namespace pellucid
