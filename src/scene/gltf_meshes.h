#pragma once

#include "scene/gltf_file.h"

#include <pellucid/scene.h>

#include <optional>
#include <vector>

namespace pellucid {

/// A primitive of a glTF mesh that became a Mesh of its own.
struct GltfPart {
    int mesh = 0;      ///< index into Scene::meshes
    int material = 0;  ///< index into Scene::materials
};

/// Reads glTF meshes when they are first asked for, into scene.meshes. Materials must be there.
class GltfMeshes {
public:
    GltfMeshes(const GltfFile& gltf, const LoadOptions& options, Scene& scene, Warnings& warnings);

    /// Parts of a mesh of the glTF file; points and lines are left out and counted.
    const std::vector<GltfPart>& parts(int gltf_mesh);

    /// Warns once about what all meshes together left out.
    void warn_about_leftovers();

private:
    void read(const tinygltf::Mesh& from, int gltf_mesh, std::vector<GltfPart>& parts);
    Mesh read_triangles(const tinygltf::Primitive& from, const std::string& name);
    void read_attributes(const tinygltf::Primitive& from, const std::string& user, Mesh& mesh);
    int material_of(const tinygltf::Primitive& from, const std::string& user);

    const GltfFile& gltf_;
    const LoadOptions& options_;
    Scene& scene_;
    Warnings& warnings_;
    std::vector<std::optional<std::vector<GltfPart>>> parts_;
    int default_material_ = -1;
    std::size_t points_or_lines_ = 0;
    bool rest_pose_ = false;
};

}  // namespace pellucid
