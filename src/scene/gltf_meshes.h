#pragma once

#include "scene/gltf_file.h"
#include "scene/gltf_solid_glass.h"
#include "scene/gltf_textures.h"
#include "scene/pose_nodes.h"
#include "scene/rig.h"

#include <pellucid/scene.h>

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace pellucid {

/// A primitive of a glTF mesh that became a Mesh of its own.
struct GltfPart {
    int mesh = 0;           ///< index into Scene::meshes
    int material = 0;       ///< index into Scene::materials
    bool in_world = false;  ///< it has a skin: its vertices are in the world's frame
};

/// Reads glTF meshes when they are first asked for, into scene.meshes; what deforms goes into the rig, too.
/// Materials, and the rig's nodes and animations, must be there. `sets`: see read_gltf_materials().
class GltfMeshes {
public:
    GltfMeshes(const GltfFile& gltf, const LoadOptions& options, const std::vector<TexcoordSets>& sets, Scene& scene,
               Rig& rig, Warnings& warnings);

    /// Parts of the mesh that a node shows; points and lines are left out and counted. Nodes share them, unless
    /// they deform them differently.
    std::vector<GltfPart> parts(int node, const NodePose& pose);

    /// Warns once about what all meshes together left out.
    void warn_about_leftovers();

private:
    struct Primitive {
        int mesh = -1;   ///< Scene::meshes, of those that do not deform
        int shape = -1;  ///< Rig::shapes, of those that do
        int material = 0;
    };
    /// A primitive on its way.
    struct Reading {
        Mesh mesh;
        Shape shape;  ///< what deforms it; Shape::base comes later
        int material = 0;
        bool deforms() const { return !shape.targets.empty() || !shape.influences.first.empty(); }
    };
    using Deformation = std::tuple<int, int, int, std::vector<float>>;  ///< shape, skin, weights' node, weights

    const std::vector<Primitive>& primitives(int gltf_mesh);
    void read(const tinygltf::Mesh& from, int gltf_mesh, std::vector<Primitive>& primitives);
    bool repair_solid_of(std::vector<Reading>& readings, const std::string& name);
    void keep(Reading& reading, bool in_parts, std::vector<Primitive>& primitives);
    Mesh read_triangles(const tinygltf::Primitive& from, const std::string& user);
    void read_attributes(const tinygltf::Primitive& from, const std::string& user, Mesh& mesh);
    int material_of(const tinygltf::Primitive& from, const std::string& user);
    int skin_of(const tinygltf::Node& node);
    std::vector<float> weights_of(const tinygltf::Node& node, const std::string& user);
    int deformed_mesh(const Deformation& how, const NodePose& pose);

    const GltfFile& gltf_;
    const LoadOptions& options_;
    const std::vector<TexcoordSets>& sets_;
    Scene& scene_;
    Rig& rig_;
    Warnings& warnings_;
    std::vector<std::optional<std::vector<Primitive>>> primitives_;
    std::vector<int> skins_;              ///< into Rig::skins, by skin of the file; -1: not read yet
    std::vector<char> animated_weights_;  ///< by node
    std::map<Deformation, int> deformed_;
    int default_material_ = -1;
    SolidGlass solid_glass_;
    std::size_t points_or_lines_ = 0;
};

}  // namespace pellucid
