// Nodes and cameras of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021, sections 3.5, 3.10).
#include "scene/load_gltf.h"

#include "core/fail.h"
#include "core/math.h"
#include "scene/gltf_file.h"
#include "scene/gltf_lights.h"
#include "scene/gltf_materials.h"
#include "scene/gltf_meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

bool finite(const glm::dmat4& m) {
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(static_cast<float>(m[c][r]))) return false;
    return true;
}

class SceneReader {
public:
    SceneReader(const GltfFile& gltf, const LoadOptions& options, Scene& scene, Warnings& warnings)
        : gltf_(gltf), scene_(scene), warnings_(warnings), meshes_(gltf, options, scene, warnings) {}

    void read() {
        struct Placed {
            int node;
            glm::dmat4 world_from_parent;
        };
        std::vector<Placed> open;  // a stack of our own: files nest as deeply as they like
        const std::vector<int> tops = roots();
        for (auto top = tops.rbegin(); top != tops.rend(); ++top) open.push_back({*top, glm::dmat4(1.0)});
        std::vector<char> visited(gltf_.model.nodes.size(), 0);
        while (!open.empty()) {
            const Placed placed = open.back();
            open.pop_back();
            if (placed.node < 0 || std::size_t(placed.node) >= visited.size())
                fail(gltf_.path, fmt::format("there is no node {}", placed.node));
            // Nodes form trees. One that is reached twice may be its own ancestor, or double the
            // scene at each of many levels.
            if (visited[std::size_t(placed.node)]++)
                fail(gltf_.path, fmt::format("node {} has more than one parent, or is its own ancestor", placed.node));
            const tinygltf::Node& node = gltf_.model.nodes[std::size_t(placed.node)];
            const glm::dmat4 world = placed.world_from_parent * local_matrix(node, placed.node);
            if (!finite(world))
                fail(gltf_.path, fmt::format("{}: transform is not finite", name_of(node, placed.node)));
            add_objects(node, placed.node, world);
            add_camera(node, placed.node, world);
            add_gltf_light(gltf_, node, name_of(node, placed.node), world, scene_, warnings_);
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                open.push_back({*child, world});
        }
        meshes_.warn_about_leftovers();
    }

private:
    static std::string name_of(const tinygltf::Node& node, int index) {
        return node.name.empty() ? fmt::format("node {}", index) : node.name;
    }

    /// Root nodes of the default scene, else of the first, else all that are nobody's child.
    std::vector<int> roots() const {
        const auto& scenes = gltf_.model.scenes;
        if (!scenes.empty()) {
            const int chosen = std::max(gltf_.model.defaultScene, 0);
            if (std::size_t(chosen) >= scenes.size()) fail(gltf_.path, fmt::format("there is no scene {}", chosen));
            return scenes[std::size_t(chosen)].nodes;
        }
        std::vector<char> is_child(gltf_.model.nodes.size(), 0);
        for (const tinygltf::Node& node : gltf_.model.nodes)
            for (const int child : node.children)
                if (child >= 0 && std::size_t(child) < is_child.size()) is_child[std::size_t(child)] = 1;
        std::vector<int> nodes;
        for (std::size_t i = 0; i < is_child.size(); ++i)
            if (!is_child[i]) nodes.push_back(static_cast<int>(i));
        return nodes;
    }

    glm::dmat4 local_matrix(const tinygltf::Node& node, int index) const {
        const auto check_size = [&](const std::vector<double>& values, std::size_t size, const char* what) {
            if (!values.empty() && values.size() != size)
                fail(gltf_.path, fmt::format("{}: {} has {} numbers instead of {}", name_of(node, index), what,
                                             values.size(), size));
            return !values.empty();
        };
        if (check_size(node.matrix, 16, "matrix")) {
            const glm::dmat4 m = glm::make_mat4(node.matrix.data());
            if (m[0][3] != 0.0 || m[1][3] != 0.0 || m[2][3] != 0.0 || m[3][3] != 1.0)
                fail(gltf_.path, fmt::format("{}: matrix is not affine", name_of(node, index)));
            return m;
        }
        glm::dmat4 m(1.0);
        if (check_size(node.translation, 3, "translation"))
            m = glm::translate(m, glm::make_vec3(node.translation.data()));
        if (check_size(node.rotation, 4, "rotation")) {
            const auto& r = node.rotation;
            const glm::dquat q(r[3], r[0], r[1], r[2]);
            const double length = glm::length(q);
            if (!(length > 0.0)) fail(gltf_.path, fmt::format("{}: rotation is zero", name_of(node, index)));
            m *= glm::mat4_cast(q / length);
        }
        if (check_size(node.scale, 3, "scale")) m = glm::scale(m, glm::make_vec3(node.scale.data()));
        return m;
    }

    void add_objects(const tinygltf::Node& node, int index, const glm::dmat4& world) {
        if (node.mesh < 0) return;
        const std::string name = name_of(node, index);
        if (std::size_t(node.mesh) >= gltf_.model.meshes.size())
            fail(gltf_.path, fmt::format("{}: there is no mesh {}", name, node.mesh));
        // Objects are taken back to their own frame in 32 bits, so the inverse must exist there.
        const glm::dmat3 linear(world);
        const double lengths = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
        const double volume = std::abs(glm::determinant(linear));
        if (volume <= 1e-9 * lengths || volume < 1e-30 || volume > 1e30) {
            warnings_.add(fmt::format("{}: scaled to nothing or out of all proportion, left out", name));
            return;
        }
        for (const GltfPart& part : meshes_.parts(node.mesh))
            scene_.objects.push_back({name, part.mesh, part.material, glm::mat4(world)});
    }

    void add_camera(const tinygltf::Node& node, int index, const glm::dmat4& world) {
        if (node.camera < 0) return;
        if (std::size_t(node.camera) >= gltf_.model.cameras.size())
            fail(gltf_.path, fmt::format("{}: there is no camera {}", name_of(node, index), node.camera));
        const tinygltf::Camera& from = gltf_.model.cameras[std::size_t(node.camera)];
        Camera camera;
        camera.name = !from.name.empty() ? from.name : name_of(node, index);
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
    Scene& scene_;
    Warnings& warnings_;
    GltfMeshes meshes_;
};

}  // namespace

Scene load_gltf(const std::filesystem::path& file, const LoadOptions& options, Warnings& warnings) {
    const GltfFile gltf = read_gltf_file(file, warnings);
    Scene scene;
    read_gltf_materials(gltf, scene, warnings);
    SceneReader(gltf, options, scene, warnings).read();
    return scene;
}

}  // namespace pellucid
