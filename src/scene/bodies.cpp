#include "scene/bodies.h"

#include "core/math.h"
#include "scene/mesh_repair.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace pellucid {
namespace {

constexpr double kVolumeTie = 1e-4;  // relative; closer volumes count as equal
constexpr int kLines = 256;          // lines per side of the grid that measures the volume of overlapping shells

struct ShellBox {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    double volume = 0.0;  // signed

    void add(const glm::dvec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    bool meets(const ShellBox& other) const {
        return glm::all(glm::lessThanEqual(low, other.high)) && glm::all(glm::lessThanEqual(other.low, high));
    }
};

/// True if the boxes of all outward shells are disjoint. Positions of cavities then do not matter.
bool apart(const std::vector<ShellBox>& boxes) {
    std::vector<const ShellBox*> order;
    for (const ShellBox& box : boxes)
        if (box.volume > 0.0) order.push_back(&box);
    std::sort(order.begin(), order.end(), [](const ShellBox* a, const ShellBox* b) { return a->low.x < b->low.x; });
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t k = i + 1; k < order.size() && order[k]->low.x <= order[i]->high.x; ++k)
            if (order[i]->meets(*order[k])) return false;
    return true;
}

/// Volume by integration along z, through the cell centres of a grid.
double volume_along_lines(const BodySurface& surface, const ShellBox& all) {
    struct Crossing {
        double z;
        int step;
    };
    const glm::dvec2 cell = glm::dvec2(all.high - all.low) / double(kLines);
    std::vector<std::vector<Crossing>> lines(std::size_t(kLines) * kLines);
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
        if (surface.shells.closed[surface.shells.of_triangle[i]] == 0) continue;
        const glm::uvec3 t = surface.triangles[i];
        const glm::dvec3 a = surface.positions[t.x], b = surface.positions[t.y], c = surface.positions[t.z];
        const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
        if (area == 0.0) continue;
        const auto first = [&](double low, int k) { return int(std::ceil((low - all.low[k]) / cell[k] - 0.5)); };
        const glm::dvec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
        for (int y = std::max(first(low.y, 1), 0); y < std::min(first(high.y, 1), kLines); ++y) {
            for (int x = std::max(first(low.x, 0), 0); x < std::min(first(high.x, 0), kLines); ++x) {
                const glm::dvec2 p = glm::dvec2(all.low) + (glm::dvec2(x, y) + 0.5) * cell;
                const double wb = ((p.x - a.x) * (c.y - a.y) - (c.x - a.x) * (p.y - a.y)) / area;
                const double wc = ((b.x - a.x) * (p.y - a.y) - (p.x - a.x) * (b.y - a.y)) / area;
                if (wb < 0.0 || wc < 0.0 || wb + wc > 1.0) continue;
                const double z = (1.0 - wb - wc) * a.z + wb * b.z + wc * c.z;
                lines[std::size_t(y) * kLines + std::size_t(x)].push_back({z, area < 0.0 ? 1 : -1});
            }
        }
    }
    double length = 0.0;
    for (std::vector<Crossing>& line : lines) {
        std::sort(line.begin(), line.end(), [](const Crossing& a, const Crossing& b) { return a.z < b.z; });
        int winding = 0;
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            winding += line[i].step;
            if (winding > 0) length += line[i + 1].z - line[i].z;
        }
    }
    return length * cell.x * cell.y;
}

/// The material with the largest share of the body's surface.
std::uint32_t material_by_area(const Scene& scene, const Body& body) {
    if (body.objects.size() == 1) return std::uint32_t(scene.objects[body.objects.front()].material);
    std::map<std::uint32_t, double> areas;
    for (std::size_t k = 0; k < body.objects.size(); ++k) {
        const Object& object = scene.objects[body.objects[k]];
        const Mesh& mesh = scene.meshes[std::size_t(object.mesh)];
        const glm::dmat3 linear(object.world_from_object);
        for (const glm::uvec3 t : mesh.triangles) {
            const glm::dvec3 a = mesh.positions[t.x];
            areas[std::uint32_t(object.material)] += glm::length(glm::cross(
                linear * (glm::dvec3(mesh.positions[t.y]) - a), linear * (glm::dvec3(mesh.positions[t.z]) - a)));
        }
    }
    return std::max_element(areas.begin(), areas.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
}

void rank_bodies(const Scene& scene, std::vector<Body>& bodies) {
    struct Claim {
        std::size_t body;
        int priority;
        double volume;
    };
    std::vector<Claim> claims;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        int priority = std::numeric_limits<int>::min();
        for (const std::uint32_t i : bodies[b].objects) priority = std::max(priority, scene.objects[i].priority);
        const glm::dmat3 linear(scene.objects[bodies[b].objects.front()].world_from_object);
        claims.push_back({b, priority, bodies[b].surface->volume * std::abs(glm::determinant(linear))});
    }
    std::sort(claims.begin(), claims.end(), [](const Claim& a, const Claim& b) {
        if (a.priority != b.priority) return a.priority < b.priority;
        return a.volume != b.volume ? a.volume > b.volume : a.body < b.body;
    });
    // Volumes that are equal but for rounding keep the order of the file.
    for (std::size_t begin = 0, end; begin < claims.size(); begin = end) {
        for (end = begin + 1; end < claims.size() && claims[end].priority == claims[begin].priority &&
                              claims[end].volume >= (1.0 - kVolumeTie) * claims[begin].volume;)
            ++end;
        std::sort(claims.begin() + std::ptrdiff_t(begin), claims.begin() + std::ptrdiff_t(end),
                  [](const Claim& a, const Claim& b) { return a.body < b.body; });
    }
    for (std::size_t rank = 0; rank < claims.size(); ++rank) bodies[claims[rank].body].rank = std::uint32_t(rank);
}

}  // namespace

bool same_medium(const Material& a, const Material& b) {
    return a.ior == b.ior && a.dispersion == b.dispersion && a.sigma_a() == b.sigma_a();
}

BodySurface body_surface(std::span<const Mesh* const> meshes) {
    BodySurface surface;
    for (const Mesh* mesh : meshes) {
        const auto first = std::uint32_t(surface.positions.size());
        surface.first_vertex.push_back(first);
        surface.first_triangle.push_back(std::uint32_t(surface.triangles.size()));
        surface.positions.insert(surface.positions.end(), mesh->positions.begin(), mesh->positions.end());
        for (const glm::uvec3 t : mesh->triangles) surface.triangles.push_back(t + first);
    }
    surface.weld = weld_positions(surface.positions);
    surface.shells = find_shells(surface.positions, surface.triangles, surface.weld);
    surface.volume = material_volume(surface);
    return surface;
}

double material_volume(const BodySurface& surface) {
    std::vector<std::vector<glm::uvec3>> triangles(surface.shells.count());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        triangles[surface.shells.of_triangle[t]].push_back(surface.triangles[t]);
    std::vector<ShellBox> boxes;
    ShellBox all;
    double sum = 0.0;
    for (std::uint32_t s = 0; s < surface.shells.count(); ++s) {
        if (surface.shells.closed[s] == 0) continue;
        ShellBox box;
        for (const glm::uvec3 t : triangles[s])
            for (int k = 0; k < 3; ++k) box.add(surface.positions[t[k]]);
        box.volume = signed_volume(surface.positions, triangles[s]).value;
        sum += box.volume;
        all.add(box.low);
        all.add(box.high);
        boxes.push_back(box);
    }
    return apart(boxes) ? sum : volume_along_lines(surface, all);
}

Bodies find_bodies(const Scene& scene) {
    Bodies bodies;
    bodies.of_object.assign(scene.objects.size(), kNoBody);
    std::map<int, std::uint32_t> numbered;  // keyed by Object::body
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        if (!scene.materials[std::size_t(object.material)].refractive()) continue;
        const auto next = std::uint32_t(bodies.all.size());
        const std::uint32_t body = object.body < 0 ? next : numbered.try_emplace(object.body, next).first->second;
        if (body == next) bodies.all.emplace_back();
        bodies.all[body].objects.push_back(i);
        bodies.of_object[i] = body;
    }
    std::map<std::vector<int>, std::shared_ptr<const BodySurface>> known;  // keyed by meshes
    for (Body& body : bodies.all) {
        std::vector<int> meshes;
        for (const std::uint32_t i : body.objects) meshes.push_back(scene.objects[i].mesh);
        std::shared_ptr<const BodySurface>& surface = known[meshes];
        if (!surface) {
            std::vector<const Mesh*> parts;
            for (const int mesh : meshes) parts.push_back(&scene.meshes[std::size_t(mesh)]);
            surface = std::make_shared<const BodySurface>(body_surface(parts));
        }
        body.surface = surface;
        body.material = material_by_area(scene, body);
    }
    rank_bodies(scene, bodies.all);
    return bodies;
}

}  // namespace pellucid
