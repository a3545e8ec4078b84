// Nodes in an animation (Khronos Group, glTF 2.0 Specification, 2021, sections 3.5.2 and 3.11).
#include "scene/pose_nodes.h"

#include "scene/keyframes.h"

#include <algorithm>

namespace pellucid {
namespace {

/// Sets what the channel drives at a time, of its node or of the node's morph targets.
void apply(const Channel& channel, double time_s, NodeTransform& node, NodePose& pose) {
    if (channel.part == AnimatedPart::kRotation) {
        node.rotation = rotation_at(channel.keyframes, time_s);
        return;
    }
    const std::vector<double> value = value_at(channel.keyframes, time_s);
    if (channel.part == AnimatedPart::kWeights) {
        pose.weights[channel.node].assign(value.begin(), value.end());
    } else {
        const bool moves_node = channel.part == AnimatedPart::kTranslation;
        (moves_node ? node.translation : node.scale) = glm::dvec3(value[0], value[1], value[2]);
    }
}

}  // namespace

glm::dmat4 NodeTransform::parent_from_node() const {
    if (matrix) return *matrix;
    return glm::scale(glm::translate(glm::dmat4(1.0), translation) * glm::mat4_cast(rotation), scale);
}

double Animation::duration_s() const {
    double duration = 0.0;
    for (const Channel& channel : channels) duration = std::max(duration, double(channel.keyframes.times.back()));
    return duration;
}

NodePose pose_nodes(const NodeTree& tree, const Animation* animation, double time_s) {
    NodePose pose;
    std::vector<NodeTransform> nodes = tree.rest;
    if (animation)
        for (const Channel& channel : animation->channels)
            apply(channel, time_s, nodes[std::size_t(channel.node)], pose);
    pose.world_from_node.assign(nodes.size(), glm::dmat4(1.0));
    for (const int node : tree.order) {
        const int parent = tree.parent[std::size_t(node)];
        const glm::dmat4 local = nodes[std::size_t(node)].parent_from_node();
        pose.world_from_node[std::size_t(node)] =
            parent < 0 ? local : pose.world_from_node[std::size_t(parent)] * local;
    }
    return pose;
}

void rebase(NodePose& pose, const glm::dvec3& origin) {
    for (glm::dmat4& world_from_node : pose.world_from_node) world_from_node[3] -= glm::dvec4(origin, 0.0);
}

glm::dmat4 world_from_mesh(const NodePose& pose, const NodeObject& object) {
    const glm::dmat4& world_from_node = pose.world_from_node[std::size_t(object.node)];
    return object.node_from_mesh ? world_from_node * *object.node_from_mesh : world_from_node;
}

glm::mat4 world_from_object(const NodePose& pose, const NodeObject& object) {
    return glm::mat4(glm::translate(world_from_mesh(pose, object), object.mesh_origin));
}

std::vector<char> moved_nodes(const NodeTree& tree, const Animation& animation) {
    std::vector<char> moved(tree.rest.size(), 0);
    for (const Channel& channel : animation.channels)
        if (channel.part != AnimatedPart::kWeights) moved[std::size_t(channel.node)] = 1;
    for (const int node : tree.order) {
        const int parent = tree.parent[std::size_t(node)];
        if (parent >= 0 && moved[std::size_t(parent)]) moved[std::size_t(node)] = 1;
    }
    return moved;
}

bool moves(const Rig& rig, const Animation& animation, const std::vector<char>& moved, const DeformedMesh& mesh) {
    const auto& channels = animation.channels;
    if (std::any_of(channels.begin(), channels.end(), [&](const Channel& channel) {
            return channel.part == AnimatedPart::kWeights && channel.node == mesh.weights_node;
        }))
        return true;
    if (mesh.skin < 0) return false;
    const std::vector<int>& joints = rig.skins[std::size_t(mesh.skin)].joints;
    return std::any_of(joints.begin(), joints.end(), [&](int joint) { return moved[std::size_t(joint)] != 0; });
}

}  // namespace pellucid
