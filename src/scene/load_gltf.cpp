// Objects and cameras of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021, sections 3.5, 3.10).
#include "scene/load_gltf.h"

#include "core/fail.h"
#include "core/math.h"
#include "scene/deform_mesh.h"
#include "scene/far_positions.h"
#include "scene/gltf_animations.h"
#include "scene/gltf_file.h"
#include "scene/gltf_instances.h"
#include "scene/gltf_lights.h"
#include "scene/gltf_materials.h"
#include "scene/gltf_meshes.h"
#include "scene/gltf_nodes.h"
#include "scene/gltf_volumes.h"
#include "scene/join_open_objects.h"
#include "scene/pose_nodes.h"
#include "scene/rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace pellucid {
namespace {

constexpr std::size_t kMostObjects = kMostInstances;

bool finite(const glm::dmat4& m) {
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(static_cast<float>(m[c][r]))) return false;
    return true;
}

class SceneReader {
public:
    SceneReader(const GltfFile& gltf, const LoadOptions& options, const std::vector<TexcoordSets>& sets, Scene& scene,
                Warnings& warnings)
        : gltf_(gltf), options_(options), sets_(sets), scene_(scene), warnings_(warnings) {}

    void read() {
        const GltfNodes nodes = read_gltf_nodes(gltf_);
        rig_.tree = nodes.tree;
        rig_.animations = read_gltf_animations(gltf_, rig_.tree, warnings_);
        NodePose pose =
            pose_nodes(rig_.tree, chosen_animation(gltf_, rig_.animations, options_), options_.time_s.value_or(0.0));
        const std::span<const int> order(rig_.tree.order.data(), nodes.in_scene);
        read_objects(order, pose, nodes.hidden);
        choose_frame(pose);
        rebase(pose, scene_.origin);
        place(pose);
        join_open_objects(scene_, moving_objects(), warnings_);
        for (const int index : order) {
            const tinygltf::Node& node = gltf_.model.nodes[std::size_t(index)];
            const glm::dmat4& world = pose.world_from_node[std::size_t(index)];
            add_camera(node, index, world);
            if (nodes.hidden[std::size_t(index)]) continue;
            add_gltf_light(gltf_, node, gltf_node_name(gltf_, index), world, scene_, warnings_);
        }
        keep_rig();
    }

private:
    /// Objects and volumes of the nodes. They are placed later, but for vertices of skins.
    void read_objects(std::span<const int> order, const NodePose& pose, const std::vector<char>& hidden) {
        GltfMeshes meshes(gltf_, options_, sets_, scene_, rig_, warnings_);
        GltfVolumes volumes(gltf_, scene_);
        for (const int index : order) {
            const tinygltf::Node& node = gltf_.model.nodes[std::size_t(index)];
            const glm::dmat4& world = pose.world_from_node[std::size_t(index)];
            const std::string name = gltf_node_name(gltf_, index);
            if (!finite(world)) fail(gltf_.path, fmt::format("{}: transform is not finite", name));
            if (hidden[std::size_t(index)]) continue;
            const std::size_t first_object = scene_.objects.size();
            if (node.mesh >= 0) add_objects(meshes, index, name, pose);
            volumes.add(node, name, world, first_object);
            volume_nodes_.resize(scene_.volume_objects.size(), index);
        }
        meshes.warn_about_leftovers();
    }

    /// Moves vertices that are stored far from their origin to it, and chooses Scene::origin.
    void choose_frame(const NodePose& pose) {
        std::vector<Box> boxes;  // of the meshes, as stored
        for (const Mesh& mesh : scene_.meshes) boxes.push_back(box_of(mesh.positions));
        std::vector<char> deforms(scene_.meshes.size(), 0);
        for (const DeformedMesh& mesh : rig_.meshes) deforms[std::size_t(mesh.mesh)] = 1;
        std::vector<glm::dvec3> origins(scene_.meshes.size(), glm::dvec3(0.0));
        for (std::size_t m = 0; m < origins.size(); ++m)
            if (!deforms[m]) origins[m] = recentre(scene_.meshes[m]);

        Box world;
        std::vector<char> goes_with_node(scene_.objects.size(), 0);
        for (NodeObject& object : rig_.objects) {
            const int mesh = scene_.objects[std::size_t(object.object)].mesh;
            goes_with_node[std::size_t(object.object)] = 1;
            object.mesh_origin = origins[std::size_t(mesh)];
            world.add(boxes[std::size_t(mesh)], world_from_mesh(pose, object));
        }
        for (std::size_t i = 0; i < scene_.objects.size(); ++i)
            if (!goes_with_node[i]) world.add(boxes[std::size_t(scene_.objects[i].mesh)], glm::dmat4(1.0));
        for (std::size_t i = 0; i < scene_.volume_objects.size(); ++i) {
            const Volume& volume = *scene_.volumes[std::size_t(scene_.volume_objects[i].volume)];
            const Box box{.low = volume.low, .high = volume.high()};
            world.add(box, pose.world_from_node[std::size_t(volume_nodes_[i])]);
        }
        scene_.origin = frame_origin(world);
        warn_about_coarse_positions(pose, boxes, world.extent());
    }

    void warn_about_coarse_positions(const NodePose& pose, const std::vector<Box>& boxes, double scene_extent) {
        CoarsePositions coarse(scene_extent);
        for (const NodeObject& object : rig_.objects) {
            const auto mesh = std::size_t(scene_.objects[std::size_t(object.object)].mesh);
            const double volume = glm::determinant(world_from_mesh(pose, object));
            coarse.add(scene_.meshes[mesh].name, boxes[mesh], std::cbrt(std::abs(volume)));
        }
        for (const DeformedMesh& mesh : rig_.meshes)
            if (const Mesh& base = rig_.shapes[mesh.shape].base; mesh.skin >= 0)
                coarse.add(base.name, box_of(base.positions), 1.0);
        coarse.warn(warnings_);
    }

    /// Transforms in the frame that was chosen.
    void place(const NodePose& pose) {
        for (const NodeObject& object : rig_.objects)
            scene_.objects[std::size_t(object.object)].world_from_object = world_from_object(pose, object);
        for (std::size_t i = 0; i < scene_.volume_objects.size(); ++i)
            scene_.volume_objects[i].world_from_volume = glm::mat4(pose.world_from_node[std::size_t(volume_nodes_[i])]);
        if (scene_.origin == glm::dvec3(0.0)) return;
        for (const DeformedMesh& mesh : rig_.meshes) {
            if (mesh.skin < 0) continue;
            DeformedVertices vertices = deform(rig_, mesh, pose);
            scene_.meshes[std::size_t(mesh.mesh)].positions = std::move(vertices.positions);
            scene_.meshes[std::size_t(mesh.mesh)].normals = std::move(vertices.normals);
        }
    }

    /// Objects are taken back to their own frame in 32 bits, so the inverse must exist there.
    static bool invertible(const glm::dmat4& world) {
        const glm::dmat3 linear(world);
        const double lengths = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
        const double volume = std::abs(glm::determinant(linear));
        return volume > 1e-9 * lengths && volume >= 1e-30 && volume <= 1e30;
    }

    void add_objects(GltfMeshes& meshes, int node, const std::string& name, const NodePose& pose) {
        const int mesh = gltf_.model.nodes[std::size_t(node)].mesh;
        if (std::size_t(mesh) >= gltf_.model.meshes.size())
            fail(gltf_.path, fmt::format("{}: there is no mesh {}", name, mesh));
        const std::optional<std::vector<glm::dmat4>> instances =
            gltf_instances(gltf_, node, name, instances_left_, warnings_);
        if (!instances) return add_parts(meshes, node, name, pose, std::nullopt);
        instances_left_ -= instances->size();
        for (const glm::dmat4& node_from_mesh : *instances) add_parts(meshes, node, name, pose, node_from_mesh);
    }

    void add_parts(GltfMeshes& meshes, int node, const std::string& name, const NodePose& pose,
                   const std::optional<glm::dmat4>& node_from_mesh) {
        const NodeObject placed{.object = -1, .node = node, .mesh_origin = {}, .node_from_mesh = node_from_mesh};
        const glm::dmat4 world = world_from_mesh(pose, placed);
        if (!finite(world)) fail(gltf_.path, fmt::format("{}: transform of an instance is not finite", name));
        const bool rigid = invertible(world);
        const std::string left_out = fmt::format("{}: scaled to nothing or out of all proportion, left out", name);
        if (!rigid && gltf_.model.nodes[std::size_t(node)].skin < 0) return warnings_.add(left_out);
        const std::vector<GltfPart> parts = meshes.parts(node, pose);
        // A short file may place a mesh of many primitives by many nodes.
        if (parts.size() > kMostObjects - scene_.objects.size())
            fail(gltf_.path, fmt::format("{}: more than {} objects in the scene; join meshes", name, kMostObjects));
        gltf_.memory.take(parts.size(), sizeof(Object) + sizeof(NodeObject) + name.size());
        const auto refracts = [&](const GltfPart& part) {
            return scene_.materials[std::size_t(part.material)].refractive();
        };
        // Refracting primitives of one instance bound one solid.
        const int body = std::count_if(parts.begin(), parts.end(), refracts) > 1 ? bodies_++ : -1;
        const int priority = read_priority(node, name);
        for (const GltfPart& part : parts) {
            // A skin says where in the world its vertices are, whatever the node's own transform is.
            if (!part.in_world && !rigid) {
                warnings_.add(left_out);
                continue;
            }
            if (!part.in_world) {
                rig_.objects.push_back(placed);
                rig_.objects.back().object = static_cast<int>(scene_.objects.size());
            }
            scene_.objects.push_back(
                {name, part.mesh, part.material, glm::mat4(1.0f), refracts(part) ? body : -1, priority});
        }
    }

    /// Node::extras.pellucid.priority: where solids overlap, the higher number wins.
    int read_priority(int node, const std::string& name) const {
        const tinygltf::Value& extras = gltf_.model.nodes[std::size_t(node)].extras;
        if (!extras.IsObject() || !extras.Has("pellucid") || !extras.Get("pellucid").IsObject()) return 0;
        const tinygltf::Value& own = extras.Get("pellucid");
        if (!own.Has("priority")) return 0;
        const tinygltf::Value& value = own.Get("priority");
        const double number = value.IsNumber() ? value.GetNumberAsDouble() : 0.5;
        if (number != std::round(number) || std::abs(number) > 1e6)
            fail(gltf_.path, fmt::format("{}: extras.pellucid.priority is no whole number within +-1000000", name));
        return int(number);
    }

    /// Per object, whether an animation moves it or its vertices.
    std::vector<char> moving_objects() const {
        std::vector<char> moves(scene_.objects.size(), 0);
        std::vector<char> nodes(rig_.tree.rest.size(), 0);
        for (const Animation& animation : rig_.animations) {
            const std::vector<char> moved = moved_nodes(rig_.tree, animation);
            for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n] = nodes[n] || moved[n];
        }
        for (const NodeObject& object : rig_.objects)
            moves[std::size_t(object.object)] = nodes[std::size_t(object.node)];
        for (const DeformedMesh& mesh : rig_.meshes)
            for (std::size_t i = 0; i < scene_.objects.size(); ++i)
                if (scene_.objects[i].mesh == mesh.mesh) moves[i] = 1;
        return moves;
    }

    /// What the file's animations move is all that posing needs.
    void keep_rig() {
        if (rig_.animations.empty()) return;
        std::vector<char> moved(rig_.tree.rest.size(), 0), deformed(rig_.meshes.size(), 0);
        for (const Animation& animation : rig_.animations) {
            const std::vector<char> nodes = moved_nodes(rig_.tree, animation);
            for (std::size_t n = 0; n < moved.size(); ++n) moved[n] = moved[n] || nodes[n];
            for (std::size_t m = 0; m < deformed.size(); ++m)
                deformed[m] = deformed[m] || moves(rig_, animation, nodes, rig_.meshes[m]);
        }
        std::erase_if(rig_.objects, [&](const NodeObject& object) { return !moved[std::size_t(object.node)]; });
        std::erase_if(rig_.meshes, [&, m = std::size_t(0)](const DeformedMesh&) mutable { return !deformed[m++]; });
        std::vector<char> used(rig_.shapes.size(), 0);
        for (const DeformedMesh& mesh : rig_.meshes) used[mesh.shape] = 1;
        for (std::size_t i = 0; i < used.size(); ++i) {
            Shape& shape = rig_.shapes[i];
            if (!used[i]) shape = {};
            shape.base.texcoords[0] = shape.base.texcoords[1] = {};
            shape.base.colors = {};
            shape.base.tangents = {};
        }
        scene_.rig = std::make_shared<const Rig>(std::move(rig_));
    }

    void add_camera(const tinygltf::Node& node, int index, const glm::dmat4& world) {
        if (node.camera < 0) return;
        if (std::size_t(node.camera) >= gltf_.model.cameras.size())
            fail(gltf_.path, fmt::format("{}: there is no camera {}", gltf_node_name(gltf_, index), node.camera));
        const tinygltf::Camera& from = gltf_.model.cameras[std::size_t(node.camera)];
        Camera camera;
        camera.name = !from.name.empty() ? from.name : gltf_node_name(gltf_, index);
        camera.orthographic = from.type == "orthographic";
        const double near_plane = camera.orthographic ? from.orthographic.znear : from.perspective.znear;
        const double far_plane = camera.orthographic ? from.orthographic.zfar : from.perspective.zfar;
        const double yfov = from.perspective.yfov, height = 2.0 * std::abs(from.orthographic.ymag);
        const bool usable =
            camera.orthographic ? height > 0.0 && height < 1e15 : yfov > 0.0 && static_cast<float>(yfov) < kPi;
        // A camera's scale has no meaning; what is left must be a rotation.
        const glm::dvec3 z = glm::normalize(glm::dvec3(world[2]));
        const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(world[1]), z));
        const glm::dmat4 rigid(glm::dvec4(x, 0.0), glm::dvec4(glm::cross(z, x), 0.0), glm::dvec4(z, 0.0), world[3]);
        if (!usable || !finite(rigid)) {
            warnings_.add(fmt::format("camera {}: left out, its projection or placement is not usable", camera.name));
            return;
        }
        camera.world_from_view = glm::mat4(rigid);
        if (camera.orthographic) {
            camera.vertical_extent = static_cast<float>(height);
        } else {
            camera.vertical_fov = static_cast<float>(yfov);
        }
        if (near_plane > 0.0 && near_plane < 1e15) camera.near_plane = static_cast<float>(near_plane);
        if (far_plane > near_plane && far_plane < 1e15) camera.far_plane = static_cast<float>(far_plane);
        scene_.cameras.push_back(std::move(camera));
    }

    const GltfFile& gltf_;
    const LoadOptions& options_;
    const std::vector<TexcoordSets>& sets_;
    Scene& scene_;
    Warnings& warnings_;
    Rig rig_;
    std::vector<int> volume_nodes_;  ///< one per volume object
    int bodies_ = 0;                 ///< given out to objects so far
    std::size_t instances_left_ = kMostInstances;
};

}  // namespace

Scene load_gltf(const std::filesystem::path& file, const LoadOptions& options, Warnings& warnings) {
    GltfFile gltf(file, options.allow_outside);
    read_gltf_file(gltf, warnings);
    Scene scene;
    const std::vector<TexcoordSets> sets = read_gltf_materials(gltf, scene, warnings);
    SceneReader(gltf, options, sets, scene, warnings).read();
    return scene;
}

}  // namespace pellucid
