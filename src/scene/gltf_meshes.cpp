// Meshes of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021, section 3.7.2).
#include "scene/gltf_meshes.h"

#include "core/fail.h"
#include "scene/gltf_accessor.h"
#include "scene/gltf_materials.h"
#include "scene/mesh_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pellucid {
namespace {

std::vector<glm::uvec3> triangles_of(int mode, const std::vector<std::uint32_t>& v) {
    std::vector<glm::uvec3> triangles;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        triangles.reserve(v.size() / 3);
        for (std::size_t i = 0; i + 2 < v.size(); i += 3) triangles.emplace_back(v[i], v[i + 1], v[i + 2]);
    } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        // Every second triangle is turned, so that all have the same winding.
        for (std::size_t i = 0; i + 2 < v.size(); ++i) triangles.emplace_back(v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]);
    } else {
        for (std::size_t i = 0; i + 2 < v.size(); ++i) triangles.emplace_back(v[i + 1], v[i + 2], v[0]);
    }
    return triangles;
}

/// Index of an attribute's accessor, or -1.
int accessor_of(const tinygltf::Primitive& primitive, const char* attribute) {
    const auto found = primitive.attributes.find(attribute);
    return found == primitive.attributes.end() ? -1 : found->second;
}

template <typename T>
bool finite(const std::vector<T>& vectors) {
    return std::all_of(vectors.begin(), vectors.end(), [](const T& v) {
        for (int k = 0; k < T::length(); ++k)
            if (!std::isfinite(v[k])) return false;
        return true;
    });
}

}  // namespace

GltfMeshes::GltfMeshes(const GltfFile& gltf, const LoadOptions& options, Scene& scene, Warnings& warnings)
    : gltf_(gltf), options_(options), scene_(scene), warnings_(warnings), parts_(gltf.model.meshes.size()) {}

const std::vector<GltfPart>& GltfMeshes::parts(int gltf_mesh) {
    auto& parts = parts_[std::size_t(gltf_mesh)];
    if (!parts) read(gltf_.model.meshes[std::size_t(gltf_mesh)], gltf_mesh, parts.emplace());
    return *parts;
}

void GltfMeshes::read(const tinygltf::Mesh& from, int gltf_mesh, std::vector<GltfPart>& parts) {
    const std::string number = std::to_string(gltf_mesh);
    for (std::size_t p = 0; p < from.primitives.size(); ++p) {
        const tinygltf::Primitive& primitive = from.primitives[p];
        const std::string user = fmt::format("mesh {} primitive {}", from.name.empty() ? number : from.name, p);
        if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
            fail(gltf_.path, fmt::format("{}: unknown mode {}", user, primitive.mode));
        if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
            ++points_or_lines_;
            continue;
        }
        rest_pose_ = rest_pose_ || !primitive.targets.empty();
        Mesh mesh = read_triangles(primitive, user);
        mesh.name = from.name.empty() ? "mesh " + number : from.name;
        if (from.primitives.size() > 1) mesh.name += fmt::format(" primitive {}", p);
        const int material = material_of(primitive, user);

        MeshOrigin origin;
        origin.refractive = scene_.materials[std::size_t(material)].refractive();
        origin.make_normals = mesh.normals.empty() || options_.remake_normals;
        // glTF asks for flat triangles where a file brings no normals (section 3.7.2.1).
        origin.crease_angle = options_.remake_normals ? options_.crease_angle : 0.0f;
        repair_mesh(mesh, origin, warnings_);
        if (mesh.triangles.empty()) {
            warnings_.add(fmt::format("{}: no triangles, left out", mesh.name));
            continue;
        }
        scene_.meshes.push_back(std::move(mesh));
        parts.push_back({static_cast<int>(scene_.meshes.size()) - 1, material});
    }
}

Mesh GltfMeshes::read_triangles(const tinygltf::Primitive& from, const std::string& user) {
    const int position = accessor_of(from, "POSITION");
    // Without positions there is nothing to draw, which the specification allows.
    if (position < 0) return {};
    Mesh mesh;
    mesh.positions = read_vectors<3>(gltf_, position, user + " POSITION");
    if (!finite(mesh.positions)) fail(gltf_.path, fmt::format("{}: a position is not finite", user));

    std::vector<std::uint32_t> vertices;
    if (from.indices >= 0) {
        vertices = read_indices(gltf_, from.indices, user + " indices");
        for (std::size_t i = 0; i < vertices.size(); ++i)
            if (vertices[i] >= mesh.positions.size())
                fail(gltf_.path, fmt::format("{}: index {} refers to vertex {}, there are {}", user, i, vertices[i],
                                             mesh.positions.size()));
    } else {
        vertices.resize(mesh.positions.size());
        std::iota(vertices.begin(), vertices.end(), 0u);
    }
    if (from.mode == TINYGLTF_MODE_TRIANGLES && vertices.size() % 3 != 0)
        warnings_.add(fmt::format("{}: the last triangle is incomplete, left out", user));
    mesh.triangles = triangles_of(from.mode, vertices);
    read_attributes(from, user, mesh);
    return mesh;
}

void GltfMeshes::read_attributes(const tinygltf::Primitive& from, const std::string& user, Mesh& mesh) {
    // One value per vertex, or none at all.
    const auto fits = [&](auto& values, const char* attribute) {
        if (values.size() >= mesh.positions.size()) {
            values.resize(mesh.positions.size());
            return;
        }
        warnings_.add(fmt::format("{}: {} left out: {} values for {} vertices", user, attribute, values.size(),
                                  mesh.positions.size()));
        values.clear();
    };
    if (const int normal = accessor_of(from, "NORMAL"); normal >= 0) {
        mesh.normals = read_vectors<3>(gltf_, normal, user + " NORMAL");
        fits(mesh.normals, "NORMAL");
    }
    for (int set = 0; set < 2; ++set) {
        const char* const attribute = set == 0 ? "TEXCOORD_0" : "TEXCOORD_1";
        const int texcoord = accessor_of(from, attribute);
        if (texcoord < 0) continue;
        auto& texcoords = mesh.texcoords[set];
        texcoords = read_vectors<2>(gltf_, texcoord, user + " " + attribute);
        fits(texcoords, attribute);
        if (!finite(texcoords)) {
            warnings_.add(fmt::format("{}: {} left out: not finite", user, attribute));
            texcoords.clear();
        }
    }
    const int color = accessor_of(from, "COLOR_0");
    if (color < 0) return;
    if (component_count(gltf_, color) == 3) {
        for (const glm::vec3 c : read_vectors<3>(gltf_, color, user + " COLOR_0")) mesh.colors.emplace_back(c, 1.0f);
    } else {
        mesh.colors = read_vectors<4>(gltf_, color, user + " COLOR_0");
    }
    fits(mesh.colors, "COLOR_0");
    if (!finite(mesh.colors)) {
        warnings_.add(fmt::format("{}: COLOR_0 left out: not finite", user));
        mesh.colors.clear();
    }
}

int GltfMeshes::material_of(const tinygltf::Primitive& from, const std::string& user) {
    if (from.material >= static_cast<int>(gltf_.model.materials.size()))
        fail(gltf_.path, fmt::format("{}: there is no material {}", user, from.material));
    if (from.material >= 0) return from.material;
    if (default_material_ < 0) {
        default_material_ = static_cast<int>(scene_.materials.size());
        scene_.materials.push_back(default_gltf_material());
    }
    return default_material_;
}

void GltfMeshes::warn_about_leftovers() {
    const std::string file = gltf_.path.filename().string();
    if (points_or_lines_ > 0)
        warnings_.add(fmt::format("{}: {} primitive{} of points or lines left out", file, points_or_lines_,
                                  points_or_lines_ == 1 ? "" : "s"));
    if (rest_pose_ || !gltf_.model.animations.empty() || !gltf_.model.skins.empty())
        warnings_.add(fmt::format("{}: animations, skins and morph targets are drawn in their rest pose", file));
}

}  // namespace pellucid
