// Node trees of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021, section 3.5).
#include "scene/gltf_nodes.h"

#include "core/fail.h"
#include "core/math.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

class NodeReader {
public:
    explicit NodeReader(const GltfFile& gltf) : gltf_(gltf) {
        const std::size_t count = gltf.model.nodes.size();
        nodes_.tree.rest.resize(count);
        nodes_.tree.parent.assign(count, -1);
        nodes_.hidden.assign(count, 0);
        placed_.assign(count, 0);
    }

    GltfNodes read() {
        place(scene_roots(), true);
        nodes_.in_scene = nodes_.tree.order.size();
        if (!gltf_.model.skins.empty()) place(all_roots(), false);
        return std::move(nodes_);
    }

private:
    struct Open {
        int node;
        int parent;
    };

    /// Places trees, each node before its children. `strict`: what cannot be placed is an error.
    void place(const std::vector<int>& roots, bool strict) {
        std::vector<Open> open;  // a stack of our own: files nest as deeply as they like
        for (auto root = roots.rbegin(); root != roots.rend(); ++root) open.push_back({*root, -1});
        while (!open.empty()) {
            const Open next = open.back();
            open.pop_back();
            if (next.node < 0 || std::size_t(next.node) >= placed_.size()) {
                if (strict) fail(gltf_.path, fmt::format("there is no node {}", next.node));
                continue;
            }
            const auto n = std::size_t(next.node);
            if (placed_[n]) {
                // Nodes form trees. One that is reached twice may be its own ancestor, or double the
                // scene at each of many levels.
                if (strict)
                    fail(gltf_.path,
                         fmt::format("node {} has more than one parent, or is its own ancestor", next.node));
                continue;
            }
            placed_[n] = 1;
            nodes_.tree.rest[n] = transform(gltf_.model.nodes[n], next.node);
            nodes_.tree.parent[n] = next.parent;
            nodes_.hidden[n] =
                hides(gltf_.model.nodes[n]) || (next.parent >= 0 && nodes_.hidden[std::size_t(next.parent)]);
            nodes_.tree.order.push_back(next.node);
            const std::vector<int>& children = gltf_.model.nodes[n].children;
            for (auto child = children.rbegin(); child != children.rend(); ++child) open.push_back({*child, next.node});
        }
    }

    static bool hides(const tinygltf::Node& node) {
        const auto found = node.extensions.find("KHR_node_visibility");
        if (found == node.extensions.end() || !found->second.IsObject() || !found->second.Has("visible")) return false;
        const tinygltf::Value& visible = found->second.Get("visible");
        return visible.IsBool() && !visible.Get<bool>();
    }

    /// Root nodes of the default scene, else of the first, else all that are nobody's child.
    std::vector<int> scene_roots() const {
        const auto& scenes = gltf_.model.scenes;
        if (scenes.empty()) return all_roots();
        const int chosen = std::max(gltf_.model.defaultScene, 0);
        if (std::size_t(chosen) >= scenes.size()) fail(gltf_.path, fmt::format("there is no scene {}", chosen));
        return scenes[std::size_t(chosen)].nodes;
    }

    std::vector<int> all_roots() const {
        std::vector<char> is_child(gltf_.model.nodes.size(), 0);
        for (const tinygltf::Node& node : gltf_.model.nodes)
            for (const int child : node.children)
                if (child >= 0 && std::size_t(child) < is_child.size()) is_child[std::size_t(child)] = 1;
        std::vector<int> nodes;
        for (std::size_t i = 0; i < is_child.size(); ++i)
            if (!is_child[i]) nodes.push_back(static_cast<int>(i));
        return nodes;
    }

    NodeTransform transform(const tinygltf::Node& node, int index) const {
        const auto given = [&](const std::vector<double>& values, std::size_t size, const char* what) {
            if (!values.empty() && values.size() != size)
                fail(gltf_.path, fmt::format("{}: {} has {} numbers instead of {}", gltf_node_name(gltf_, index), what,
                                             values.size(), size));
            return !values.empty();
        };
        NodeTransform result;
        if (given(node.matrix, 16, "matrix")) {
            glm::dmat4 m = glm::make_mat4(node.matrix.data());
            constexpr double kRounding = 1e-5;
            const glm::dvec4 last_row(m[0][3], m[1][3], m[2][3], m[3][3] - 1.0);
            for (int k = 0; k < 4; ++k) {
                if (!(std::abs(last_row[k]) <= kRounding))
                    fail(gltf_.path, fmt::format("{}: matrix is not affine", gltf_node_name(gltf_, index)));
                m[k][3] = k == 3 ? 1.0 : 0.0;
            }
            result.matrix = m;
            return result;
        }
        if (given(node.translation, 3, "translation")) result.translation = glm::make_vec3(node.translation.data());
        if (given(node.rotation, 4, "rotation")) {
            const auto& r = node.rotation;
            const glm::dquat q(r[3], r[0], r[1], r[2]);
            const double length = glm::length(q);
            if (!(length > 0.0)) fail(gltf_.path, fmt::format("{}: rotation is zero", gltf_node_name(gltf_, index)));
            result.rotation = q / length;
        }
        if (given(node.scale, 3, "scale")) result.scale = glm::make_vec3(node.scale.data());
        return result;
    }

    const GltfFile& gltf_;
    GltfNodes nodes_;
    std::vector<char> placed_;
};

}  // namespace

GltfNodes read_gltf_nodes(const GltfFile& gltf) { return NodeReader(gltf).read(); }

std::string gltf_node_name(const GltfFile& gltf, int node) {
    const std::string& name = gltf.model.nodes[std::size_t(node)].name;
    return name.empty() ? fmt::format("node {}", node) : name;
}

}  // namespace pellucid
