// Meshes of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021, section 3.7.2).
#include "scene/gltf_meshes.h"

#include "core/fail.h"
#include "scene/bodies.h"
#include "scene/deform_mesh.h"
#include "scene/gltf_accessor.h"
#include "scene/gltf_animations.h"
#include "scene/gltf_materials.h"
#include "scene/gltf_nodes.h"
#include "scene/gltf_skins.h"
#include "scene/mesh_repair.h"
#include "scene/repair_solid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

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
int accessor_of(const tinygltf::Primitive& primitive, const std::string& attribute) {
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

/// Brings what deforms a mesh in line with its repaired vertices.
void follow_repair(Shape& shape, const MeshRepair& repair, const MeshOrigin& origin) {
    gather_influences(shape.influences, repair.source);
    gather_targets(shape.targets, repair.source);
    if (repair.normals_turned)
        for (MorphTarget& target : shape.targets)
            for (glm::vec3& n : target.normals) n = -n;
    if (!origin.make_normals) return;
    for (MorphTarget& target : shape.targets) target.normals.clear();
    if (origin.crease_angle > 0.0f) {
        shape.normal_group = weld_vertices(shape.base.positions, shape.base.normals);
    } else {
        // Flat triangles have vertices of their own, also where they lie in one plane now.
        shape.normal_group.resize(shape.base.positions.size());
        std::iota(shape.normal_group.begin(), shape.normal_group.end(), 0u);
    }
}

}  // namespace

GltfMeshes::GltfMeshes(const GltfFile& gltf, const LoadOptions& options, const std::vector<TexcoordSets>& sets,
                       Scene& scene, Rig& rig, Warnings& warnings)
    : gltf_(gltf), options_(options), sets_(sets), scene_(scene), rig_(rig), warnings_(warnings),
      primitives_(gltf.model.meshes.size()), skins_(gltf.model.skins.size(), -1),
      animated_weights_(gltf.model.nodes.size(), 0), solid_glass_(options.solid, scene, warnings) {
    for (const Animation& animation : rig.animations)
        for (const Channel& channel : animation.channels)
            if (channel.part == AnimatedPart::kWeights) animated_weights_[std::size_t(channel.node)] = 1;
}

std::vector<GltfPart> GltfMeshes::parts(int node_index, const NodePose& pose) {
    const tinygltf::Node& node = gltf_.model.nodes[std::size_t(node_index)];
    const std::string user = gltf_node_name(gltf_, node_index);
    const int skin = skin_of(node);
    std::vector<GltfPart> parts;
    for (const Primitive& primitive : primitives(node.mesh)) {
        const Shape* const shape = primitive.shape < 0 ? nullptr : &rig_.shapes[std::size_t(primitive.shape)];
        const bool skinned = skin >= 0 && shape && !shape->influences.first.empty();
        if (skin >= 0 && !skinned)
            warnings_.add(fmt::format("{}: its skin is ignored, the mesh has no joints and weights", user));
        const bool morphed = shape && !shape->targets.empty();
        GltfPart part{.mesh = primitive.mesh, .material = primitive.material, .in_world = skinned};
        if (shape)
            part.mesh = deformed_mesh({primitive.shape, skinned ? skin : -1,
                                       morphed && animated_weights_[std::size_t(node_index)] ? node_index : -1,
                                       morphed ? weights_of(node, user) : std::vector<float>()},
                                      pose);
        parts.push_back(part);
    }
    return parts;
}

const std::vector<GltfMeshes::Primitive>& GltfMeshes::primitives(int gltf_mesh) {
    auto& primitives = primitives_[std::size_t(gltf_mesh)];
    if (!primitives) read(gltf_.model.meshes[std::size_t(gltf_mesh)], gltf_mesh, primitives.emplace());
    return *primitives;
}

int GltfMeshes::skin_of(const tinygltf::Node& node) {
    if (node.skin < 0) return -1;
    if (std::size_t(node.skin) >= skins_.size()) fail(gltf_.path, fmt::format("there is no skin {}", node.skin));
    int& skin = skins_[std::size_t(node.skin)];
    if (skin < 0) {
        rig_.skins.push_back(read_gltf_skin(gltf_, node.skin, rig_.tree));
        skin = static_cast<int>(rig_.skins.size()) - 1;
    }
    return skin;
}

/// The node's own, else the mesh's, else zeros; one for each morph target.
std::vector<float> GltfMeshes::weights_of(const tinygltf::Node& node, const std::string& user) {
    const tinygltf::Mesh& mesh = gltf_.model.meshes[std::size_t(node.mesh)];
    const std::vector<double>& given = node.weights.empty() ? mesh.weights : node.weights;
    std::vector<float> weights(given.begin(), given.end());
    const std::size_t targets = morph_target_count(mesh);
    if (!weights.empty() && weights.size() != targets)
        warnings_.add(fmt::format("{}: {} weights for {} morph targets", user, weights.size(), targets));
    weights.resize(targets, 0.0f);
    for (const float weight : weights)
        if (!std::isfinite(weight)) fail(gltf_.path, fmt::format("{}: a weight is too large", user));
    return weights;
}

/// Index into Scene::meshes of a shape deformed in one way.
int GltfMeshes::deformed_mesh(const Deformation& how, const NodePose& pose) {
    const auto known = deformed_.find(how);
    if (known != deformed_.end()) return known->second;
    const auto& [shape_index, skin, weights_node, weights] = how;
    const Shape& shape = rig_.shapes[std::size_t(shape_index)];
    if (skin >= 0)
        check_influences(gltf_, shape.influences, rig_.skins[std::size_t(skin)].joints.size(), shape.base.name);
    DeformedMesh deformed{.mesh = static_cast<int>(scene_.meshes.size()),
                          .shape = std::size_t(shape_index),
                          .skin = skin,
                          .weights_node = weights_node,
                          .weights = weights};
    deformed.mirrored = skin_mirrors(rig_, deformed, pose);
    DeformedVertices vertices = deform(rig_, deformed, pose);
    if (!vertices.finite()) fail(gltf_.path, fmt::format("{}: a posed position is not finite", shape.base.name));
    Mesh mesh = shape.base;
    mesh.positions = std::move(vertices.positions);
    mesh.normals = std::move(vertices.normals);
    mesh.tangents = {};
    if (deformed.mirrored)
        for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    scene_.meshes.push_back(std::move(mesh));
    rig_.meshes.push_back(std::move(deformed));
    return deformed_[how] = rig_.meshes.back().mesh;
}

void GltfMeshes::read(const tinygltf::Mesh& from, int gltf_mesh, std::vector<Primitive>& primitives) {
    const std::string number = std::to_string(gltf_mesh);
    const std::string name = from.name.empty() ? "mesh " + number : from.name;
    std::vector<Reading> readings;
    for (std::size_t p = 0; p < from.primitives.size(); ++p) {
        const tinygltf::Primitive& primitive = from.primitives[p];
        const std::string user = fmt::format("mesh {} primitive {}", from.name.empty() ? number : from.name, p);
        if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
            fail(gltf_.path, fmt::format("{}: unknown mode {}", user, primitive.mode));
        if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
            ++points_or_lines_;
            continue;
        }
        Reading reading;
        reading.material = material_of(primitive, user);
        reading.mesh = read_triangles(primitive, user);
        reading.mesh.name = name;
        if (from.primitives.size() > 1) reading.mesh.name += fmt::format(" primitive {}", p);
        const std::size_t vertices = reading.mesh.positions.size();
        reading.shape.targets = read_gltf_targets(gltf_, primitive, vertices, user, warnings_);
        if (!gltf_.model.skins.empty())
            reading.shape.influences = read_gltf_influences(gltf_, primitive, vertices, user, warnings_);
        readings.push_back(std::move(reading));
    }
    std::vector<SolidGlass::Part> parts;
    for (Reading& reading : readings) parts.push_back({&reading.mesh, &reading.material});
    solid_glass_.apply(parts);
    const bool in_parts = repair_solid_of(readings, name);
    for (Reading& reading : readings) keep(reading, in_parts, primitives);
}

/// Refracting primitives of one mesh bound one solid. Returns whether there are several, which have been repaired.
bool GltfMeshes::repair_solid_of(std::vector<Reading>& readings, const std::string& name) {
    std::vector<Mesh*> parts;
    const Material* first = nullptr;
    bool alike = true;
    for (Reading& reading : readings) {
        const Material& material = scene_.materials[std::size_t(reading.material)];
        if (!material.refractive() || reading.deforms()) continue;
        parts.push_back(&reading.mesh);
        if (!first) first = &material;
        alike = alike && same_medium(material, *first);
    }
    if (parts.size() < 2) return false;
    if (!alike)
        warnings_.add(
            fmt::format("{}: its primitives bound one solid, but are of several media; all of it is of the "
                        "medium of most of its surface",
                        name));
    repair_solid_in_parts(parts, name, warnings_);
    return true;
}

void GltfMeshes::keep(Reading& reading, bool in_parts, std::vector<Primitive>& primitives) {
    const bool deforms = reading.deforms();
    MeshOrigin origin;
    const Material& looks = scene_.materials[std::size_t(reading.material)];
    origin.refractive = looks.refractive() || looks.translucent() || options_.translucent.has_value();
    origin.part_of_solid = in_parts && looks.refractive() && !deforms;
    origin.make_normals = reading.mesh.normals.empty() || options_.remake_normals;
    // glTF asks for flat triangles where a file brings no normals (section 3.7.2.1).
    origin.crease_angle = options_.remake_normals ? options_.crease_angle : 0.0f;
    origin.deforms = deforms;
    const MeshRepair repair = repair_mesh(reading.mesh, origin, warnings_);
    if (reading.mesh.triangles.empty()) {
        warnings_.add(fmt::format("{}: no triangles, left out", reading.mesh.name));
        return;
    }
    if (deforms) {
        reading.shape.base = std::move(reading.mesh);
        follow_repair(reading.shape, repair, origin);
        rig_.shapes.push_back(std::move(reading.shape));
        primitives.push_back({.shape = static_cast<int>(rig_.shapes.size()) - 1, .material = reading.material});
    } else {
        scene_.meshes.push_back(std::move(reading.mesh));
        primitives.push_back({.mesh = static_cast<int>(scene_.meshes.size()) - 1, .material = reading.material});
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
    const auto fits = [&](auto& values, const std::string& attribute) {
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
    const int tangent = accessor_of(from, "TANGENT");
    if (tangent >= 0 && !mesh.normals.empty()) {
        mesh.tangents = read_vectors<4>(gltf_, tangent, user + " TANGENT");
        fits(mesh.tangents, "TANGENT");
        if (!finite(mesh.tangents)) {
            warnings_.add(fmt::format("{}: TANGENT left out: not finite", user));
            mesh.tangents.clear();
        }
    }
    const TexcoordSets sets = from.material < 0 ? TexcoordSets{0, 1} : sets_[std::size_t(from.material)];
    for (std::size_t slot = 0; slot < sets.size(); ++slot) {
        const std::string attribute = fmt::format("TEXCOORD_{}", sets[slot]);
        const int texcoord = accessor_of(from, attribute);
        if (texcoord < 0) continue;
        auto& texcoords = mesh.texcoords[slot];
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
    solid_glass_.warn();
}

}  // namespace pellucid
