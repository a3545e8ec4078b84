#include "lab/experiment_scenes.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace pellucid::cli {
namespace {

/// One solid of glass and its placement.
struct Placed {
    const char* shape;
    glm::vec3 position;  ///< m
    float scale = 1.0f;
    float turn_deg = 0.0f;  ///< about +Y
};

/// The view looks down by 15 degrees: objects behind must stand lower, or they would appear above.
constexpr float kDropPerMetre = 0.268f;

glm::vec3 behind(float metres, float right = 0.0f) { return {right, -kDropPerMetre * metres, -metres}; }

Scene scene_of(std::initializer_list<Placed> all) {
    Scene scene;
    for (const Placed& placed : all) {
        Scene one = load_scene(std::string("shape:") + placed.shape);
        Object object = one.objects.front();
        object.mesh = int(scene.meshes.size());
        object.material = 0;
        object.world_from_object = glm::translate(glm::mat4(1.0f), placed.position);
        object.world_from_object =
            glm::rotate(object.world_from_object, glm::radians(placed.turn_deg), glm::vec3(0.0f, 1.0f, 0.0f));
        object.world_from_object = glm::scale(object.world_from_object, glm::vec3(placed.scale));
        if (scene.materials.empty()) scene.materials = one.materials;
        scene.meshes.push_back(std::move(one.meshes.front()));
        scene.objects.push_back(std::move(object));
    }
    return scene;
}

/// The vertices of each hole of a mesh, in the direction in which a fan that closes it runs.
std::vector<std::vector<std::uint32_t>> holes(const Mesh& mesh) {
    std::map<std::array<float, 3>, std::uint32_t> known;  // vertices of one position are one
    std::vector<std::uint32_t> weld;
    for (const glm::vec3& p : mesh.positions)
        weld.push_back(known.try_emplace({p.x, p.y, p.z}, std::uint32_t(weld.size())).first->second);
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const glm::uvec3 t : mesh.triangles)
        for (int k = 0; k < 3; ++k) edges.emplace(weld[t[k]], weld[t[(k + 1) % 3]]);
    std::map<std::uint32_t, std::uint32_t> next;  // along the rims
    for (const auto& [from, to] : edges)
        if (!edges.contains({to, from})) next[to] = from;
    std::vector<std::vector<std::uint32_t>> found;
    while (!next.empty()) {
        std::vector<std::uint32_t> rim;
        for (auto at = next.begin(); at != next.end();) {
            rim.push_back(at->first);
            const std::uint32_t following = at->second;
            next.erase(at);
            at = next.find(following);
        }
        if (rim.size() >= 3) found.push_back(std::move(rim));
    }
    return found;
}

/// Inverse of the map's projection (see Environment).
glm::vec3 direction_at(double u, double v) {
    const double longitude = (u - 0.5) * 2.0 * std::numbers::pi, colatitude = v * std::numbers::pi;
    return {std::sin(colatitude) * std::cos(longitude), std::cos(colatitude),
            std::sin(colatitude) * std::sin(longitude)};
}

}  // namespace

Scene cube_before_knot() {
    return scene_of({{"cube", {0.0f, 0.0f, 0.0f}, 1.0f, 20.0f}, {"knot", behind(2.2f, 0.2f), 0.9f}});
}

Scene sphere_before_sphere() {
    return scene_of({{"sphere", {0.0f, 0.0f, 0.0f}, 0.8f}, {"sphere", behind(2.4f, 0.7f), 0.8f}});
}

Scene five_objects() {
    return scene_of({{"sphere", {-0.9f, -0.3f, 0.6f}, 0.6f},
                     {"gem", {0.8f, -0.3f, 0.8f}, 0.6f},
                     {"goblet", behind(0.9f), 1.0f},
                     {"cube", behind(2.2f, -1.1f), 0.9f, 30.0f},
                     {"torus", behind(2.6f, 1.1f), 0.9f, 25.0f}});
}

void close_holes(Scene& scene) {
    std::size_t closed = 0;
    for (Mesh& mesh : scene.meshes) {
        for (const std::vector<std::uint32_t>& rim : holes(mesh)) {
            glm::vec3 middle(0.0f);
            for (const std::uint32_t vertex : rim) middle += mesh.positions[vertex] / float(rim.size());
            for (std::size_t i = 0; i < rim.size(); ++i) {
                const glm::vec3 corners[] = {middle, mesh.positions[rim[i]], mesh.positions[rim[(i + 1) % rim.size()]]};
                const glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
                const auto first = std::uint32_t(mesh.positions.size());
                for (const glm::vec3& corner : corners) {
                    mesh.positions.push_back(corner);
                    mesh.normals.push_back(normal);
                }
                mesh.triangles.emplace_back(first, first + 1, first + 2);
            }
            ++closed;
        }
        for (auto& set : mesh.texcoords) set.resize(set.empty() ? 0 : mesh.positions.size());
        if (!mesh.colors.empty()) mesh.colors.resize(mesh.positions.size(), glm::vec4(1.0f));
        if (!mesh.tangents.empty()) mesh.tangents.resize(mesh.positions.size(), glm::vec4(0.0f));
    }
    scene.warnings = {fmt::format("{} holes are closed by flat triangles", closed)};
}

Environment resampled(const Environment& environment, int width) {
    constexpr int kPerTexel = 4;  // along each axis
    Environment map;
    map.kind = Environment::Kind::kMap;
    map.map = Image(width, width / 2, 3);
    for (int y = 0; y < map.map.height; ++y) {
        for (int x = 0; x < width; ++x) {
            glm::vec3 sum(0.0f);
            for (int i = 0; i < kPerTexel * kPerTexel; ++i) {
                const double u = (x + (i % kPerTexel + 0.5) / kPerTexel) / width;
                const double v = (y + (i / kPerTexel + 0.5) / kPerTexel) / map.map.height;
                sum += radiance(environment, direction_at(u, v));
            }
            for (int k = 0; k < 3; ++k) map.map.at(x, y)[k] = sum[k] / float(kPerTexel * kPerTexel);
        }
    }
    return map;
}

}  // namespace pellucid::cli
