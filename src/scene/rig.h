#pragma once

// What of a file can move, kept so that it can be posed (Scene::rig).

#include "core/math.h"

#include <pellucid/scene.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// Where a node stands in its parent's frame: translation * rotation * scale, or a matrix instead.
struct NodeTransform {
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< unit
    glm::dvec3 scale{1.0};
    std::optional<glm::dmat4> matrix;  ///< affine; such a node cannot be animated
    glm::dmat4 parent_from_node() const;
};

/// The nodes of a file.
struct NodeTree {
    std::vector<NodeTransform> rest;  ///< one per node of the file
    std::vector<int> parent;          ///< -1: none
    std::vector<int> order;           ///< every node that is placed, after its parent
};

enum class Interpolation { kStep, kLinear, kCubicSpline };

/// Values of `width` numbers at given times. Between two keys they are interpolated, beyond the ends they stay.
struct Keyframes {
    std::vector<float> times;  ///< s, at least one, finite, never decreasing
    /// One value per key; of cubic splines three: tangent before the key, value, tangent after it (per s).
    std::vector<float> values;
    std::size_t width = 0;
    Interpolation interpolation = Interpolation::kLinear;
};

/// What of a node keyframes drive.
enum class AnimatedPart { kTranslation, kRotation, kScale, kWeights };

struct Channel {
    int node = 0;
    AnimatedPart part = AnimatedPart::kTranslation;
    Keyframes keyframes;
};

struct Animation {
    std::string name;
    std::vector<Channel> channels;
    double duration_s() const;  ///< time of the last key
};

/// Displacements of all vertices of a mesh; a list is empty where nothing is displaced.
struct MorphTarget {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
};

/// Which joints a vertex follows: those of vertex v are first[v] .. first[v + 1], weights add to 1.
struct Influences {
    std::vector<std::uint32_t> first;  ///< empty: the mesh has no skin; else one more than vertices
    std::vector<std::uint32_t> joint;  ///< index into Skin::joints
    std::vector<float> weight;         ///< > 0
};

/// A mesh before it is morphed and skinned; several DeformedMesh may show it.
struct Shape {
    Mesh base;
    std::vector<MorphTarget> targets;
    Influences influences;
    /// If the file brings no normals: vertices with one number share the normal of their triangles. Else empty.
    std::vector<std::uint32_t> normal_group;
};

struct Skin {
    std::vector<int> joints;                  ///< nodes
    std::vector<glm::dmat4> joint_from_bind;  ///< inverse bind matrices, one per joint
};

/// A mesh of the scene whose vertices come from a shape. With a skin they are in the world's frame.
struct DeformedMesh {
    int mesh = 0;           ///< Scene::meshes
    std::size_t shape = 0;  ///< Rig::shapes
    int skin = -1;          ///< Rig::skins
    int weights_node = -1;  ///< whose animated weights drive the targets
    std::vector<float> weights;
    bool mirrored = false;  ///< the skin mirrors: Scene's triangles are wound the other way than the shape's
};

/// An object that goes with a node.
struct NodeObject {
    int object = 0;  ///< Scene::objects
    int node = 0;
    glm::dvec3 mesh_origin{0.0};               ///< in the file's mesh: where the origin of Scene's mesh lies
    std::optional<glm::dmat4> node_from_mesh;  ///< of an instance (EXT_mesh_gpu_instancing); none: the identity
};

struct Rig {
    NodeTree tree;
    std::vector<Animation> animations;
    std::vector<Shape> shapes;
    std::vector<Skin> skins;
    std::vector<DeformedMesh> meshes;
    std::vector<NodeObject> objects;
};

}  // namespace pellucid
