#include "scene/join_open_objects.h"

#include "core/math.h"
#include "scene/bodies.h"
#include "scene/mesh_edges.h"
#include "scene/repair_solid.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

namespace pellucid {
namespace {

/// The object's mesh, transformed into the frame of `target`. Its tangents are left out; add_tangents() makes them anew.
Mesh in_frame(const Scene& scene, const Object& object, const Object& target) {
    Mesh mesh = scene.meshes[std::size_t(object.mesh)];
    mesh.tangents.clear();
    const glm::dmat4 to_target =
        glm::inverse(glm::dmat4(target.world_from_object)) * glm::dmat4(object.world_from_object);
    const glm::dmat3 normals = glm::inverseTranspose(glm::dmat3(to_target));
    for (glm::vec3& p : mesh.positions) p = glm::vec3(to_target * glm::dvec4(glm::dvec3(p), 1.0));
    for (glm::vec3& n : mesh.normals) n = glm::vec3(glm::normalize(normals * glm::dvec3(n)));
    if (glm::determinant(to_target) < 0.0)
        for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    return mesh;
}

/// Objects of one medium in one frame, connected by shared open edges.
class Neighbours {
public:
    Neighbours(const Scene& scene, std::vector<std::uint32_t> objects) : objects_(std::move(objects)) {
        std::vector<glm::vec3> positions;
        std::vector<glm::uvec3> triangles;
        for (std::uint32_t k = 0; k < objects_.size(); ++k) {
            const Mesh mesh = in_frame(scene, scene.objects[objects_[k]], scene.objects[objects_.front()]);
            const auto first = std::uint32_t(positions.size());
            positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
            for (const glm::uvec3 t : mesh.triangles) {
                triangles.push_back(t + first);
                owner_.push_back(k);
            }
        }
        weld(positions);
        sides_ = sorted_half_edges(triangles, weld_);
    }

    /// Groups of two or more objects that have no open edge together.
    std::vector<std::vector<std::uint32_t>> closed_groups() {
        DisjointSets sets(objects_.size());
        for_each_edge(sides_, [&](std::span<const HalfEdge> edge) {
            for (const HalfEdge& side : edge) sets.join(owner_[side.triangle], owner_[edge[0].triangle]);
        });
        std::set<std::uint32_t> open;
        for_each_edge(sides_, [&](std::span<const HalfEdge> edge) {
            if (edge.size() % 2 != 0) open.insert(sets.root(owner_[edge[0].triangle]));
        });
        std::map<std::uint32_t, std::vector<std::uint32_t>> groups;
        for (std::uint32_t k = 0; k < objects_.size(); ++k) groups[sets.root(k)].push_back(objects_[k]);
        std::vector<std::vector<std::uint32_t>> closed;
        for (auto& [root, group] : groups)
            if (group.size() > 1 && !open.contains(root)) closed.push_back(std::move(group));
        return closed;
    }

private:
    /// Welds positions with a tolerance, because each object's positions were rounded in its own frame.
    void weld(const std::vector<glm::vec3>& positions) {
        std::vector<std::uint32_t> all(positions.size());
        std::iota(all.begin(), all.end(), 0u);
        DisjointSets sets = near_vertices(positions, all, weld_tolerance(positions));
        for (std::uint32_t v = 0; v < positions.size(); ++v) weld_.push_back(sets.root(v));
    }

    std::vector<std::uint32_t> objects_, owner_, weld_;
    std::vector<HalfEdge> sides_;
};

/// True if the parts bound a solid; coincident sheets do not.
bool bound_a_solid(const std::vector<Mesh>& parts) {
    std::vector<const Mesh*> meshes;
    for (const Mesh& part : parts) meshes.push_back(&part);
    const BodySurface surface = body_surface(meshes);
    return !surface.triangles.empty() && surface.shells.all_closed() && surface.volume > 0.0;
}

void join(Scene& scene, const std::vector<std::uint32_t>& group, int body, Warnings& warnings) {
    const Object first = scene.objects[group.front()];
    std::vector<Mesh> parts;
    std::vector<std::string> names;
    for (const std::uint32_t i : group) {
        parts.push_back(in_frame(scene, scene.objects[i], first));
        names.push_back(parts.back().name);
    }
    const std::string name = fmt::format("{}", fmt::join(names, " and "));
    std::vector<Mesh*> together;
    for (Mesh& part : parts) together.push_back(&part);
    Warnings of_repair;
    repair_solid_in_parts(together, name, of_repair);
    if (!bound_a_solid(parts)) return;
    for (const std::string& line : of_repair.lines()) warnings.add(line);
    for (const std::string& part : names) warnings.drop(fmt::format("{}: ", part), "not a closed solid");
    warnings.add(fmt::format("{}: open surfaces that close each other, joined to one solid", name));
    for (std::size_t k = 0; k < group.size(); ++k) {
        Object& object = scene.objects[group[k]];
        object.mesh = int(scene.meshes.size());
        object.world_from_object = first.world_from_object;
        object.body = body;
        scene.meshes.push_back(std::move(parts[k]));
    }
}

}  // namespace

void join_open_objects(Scene& scene, const std::vector<char>& moves, Warnings& warnings) {
    const Bodies bodies = find_bodies(scene);
    std::vector<std::vector<std::uint32_t>> by_medium;
    int next_body = 0;
    for (const Object& object : scene.objects) next_body = std::max(next_body, object.body + 1);
    for (const Body& body : bodies.all) {
        const bool fixed =
            std::none_of(body.objects.begin(), body.objects.end(), [&](auto i) { return moves[i] != 0; });
        const Shells& shells = body.surface->shells;
        const bool open =
            std::none_of(shells.closed.begin(), shells.closed.end(), [](char closed) { return closed != 0; });
        if (!fixed || !open || body.objects.size() > 1) continue;
        const std::uint32_t object = body.objects.front();
        const auto material = [&](std::uint32_t i) -> const Material& {
            return scene.materials[std::size_t(scene.objects[i].material)];
        };
        const auto known = std::find_if(by_medium.begin(), by_medium.end(), [&](const auto& group) {
            return same_medium(material(group.front()), material(object));
        });
        if (known != by_medium.end()) {
            known->push_back(object);
        } else {
            by_medium.push_back({object});
        }
    }
    for (const std::vector<std::uint32_t>& objects : by_medium) {
        if (objects.size() < 2) continue;
        for (const std::vector<std::uint32_t>& group : Neighbours(scene, objects).closed_groups())
            join(scene, group, next_body++, warnings);
    }
}

}  // namespace pellucid
