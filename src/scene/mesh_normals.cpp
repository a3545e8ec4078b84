#include "scene/mesh_normals.h"

#include "core/math.h"
#include "scene/crease_angles.h"
#include "scene/mesh_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace pellucid {
namespace {

/// Normals of the triangles; their length is twice the triangle's area.
std::vector<glm::dvec3> area_vectors(const Mesh& mesh) {
    std::vector<glm::dvec3> vectors(mesh.triangles.size());
    std::transform(mesh.triangles.begin(), mesh.triangles.end(), vectors.begin(), [&](glm::uvec3 t) {
        const glm::dvec3 a = mesh.positions[t.x];
        return glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
    });
    return vectors;
}

bool usable(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0.0 && std::isfinite(length);
}

/// Smooth normals per position, indexed by the welded vertex.
std::vector<glm::vec3> smooth_normals(const Mesh& mesh, const std::vector<std::uint32_t>& weld) {
    const std::vector<glm::dvec3> areas = area_vectors(mesh);
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
    std::vector<double> total(mesh.positions.size(), 0.0);
    std::vector<std::uint32_t> largest(mesh.positions.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const double area = glm::length(areas[t]);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = weld[mesh.triangles[t][k]];
            sums[v] += areas[t];
            total[v] += area;
            if (area >= glm::length(areas[largest[v]]) || total[v] == area) largest[v] = static_cast<std::uint32_t>(t);
        }
    }
    std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0.0f, 0.0f, 1.0f));
    for (std::size_t v = 0; v < normals.size(); ++v) {
        // On a double-sided sheet the sum vanishes up to rounding; use the largest triangle's side.
        const bool cancelled = glm::length(sums[v]) <= 1e-9 * total[v];
        const glm::dvec3 n = cancelled && !areas.empty() ? areas[largest[v]] : sums[v];
        if (usable(n)) normals[v] = glm::normalize(n);
    }
    return normals;
}

/// A corner of a triangle at the current vertex.
struct Corner {
    std::uint32_t triangle;
    std::uint32_t slot;   ///< 0..2
    std::uint32_t group;  ///< corners of one group share a normal
};

/// One of a corner's two edges at its vertex.
struct Spoke {
    std::uint32_t far_vertex;
    std::uint32_t corner;
};

std::uint32_t root_of(std::vector<Corner>& corners, std::uint32_t i) {
    while (corners[i].group != i) i = corners[i].group = corners[corners[i].group].group;
    return i;
}

/// Joins the corners around one vertex across every edge bent less than the crease angle.
void group_corners(const Mesh& mesh, const std::vector<std::uint32_t>& weld, const std::vector<glm::dvec3>& areas,
                   double cos_crease, std::vector<Corner>& corners, std::vector<Spoke>& spokes) {
    spokes.clear();
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
        const glm::uvec3 t = mesh.triangles[corners[i].triangle];
        spokes.push_back({weld[t[(corners[i].slot + 1) % 3]], i});
        spokes.push_back({weld[t[(corners[i].slot + 2) % 3]], i});
    }
    std::sort(spokes.begin(), spokes.end(), [](const Spoke& a, const Spoke& b) {
        return a.far_vertex != b.far_vertex ? a.far_vertex < b.far_vertex : a.corner < b.corner;
    });
    for (std::size_t s = 1; s < spokes.size(); ++s) {
        if (spokes[s].far_vertex != spokes[s - 1].far_vertex) continue;
        const glm::dvec3 a = areas[corners[spokes[s - 1].corner].triangle];
        const glm::dvec3 b = areas[corners[spokes[s].corner].triangle];
        if (glm::dot(a, b) > cos_crease * glm::length(a) * glm::length(b))
            corners[root_of(corners, spokes[s].corner)].group = root_of(corners, spokes[s - 1].corner);
    }
    for (std::uint32_t i = 0; i < corners.size(); ++i) corners[i].group = root_of(corners, i);
}

/// Corners of all triangles, ordered by welded vertex. Vertex v has the entries first[v]..first[v+1].
struct CornerTable {
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> corner;  ///< 3 * triangle + slot
};

CornerTable corners_by_vertex(const Mesh& mesh, const std::vector<std::uint32_t>& weld) {
    CornerTable table;
    table.first.assign(mesh.positions.size() + 1, 0);
    for (const glm::uvec3 t : mesh.triangles)
        for (int k = 0; k < 3; ++k) ++table.first[weld[t[k]] + 1];
    std::partial_sum(table.first.begin(), table.first.end(), table.first.begin());
    table.corner.resize(mesh.triangles.size() * 3);
    std::vector<std::uint32_t> next(table.first.begin(), table.first.end() - 1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k)
            table.corner[next[weld[mesh.triangles[t][int(k)]]]++] = std::uint32_t(3 * t) + k;
    return table;
}

/// Generates normals with creases. `crease_angles`: one per welded vertex; pi joins all of its corners. Returns the
/// old vertex of each new vertex.
std::vector<std::uint32_t> make_creased_normals(Mesh& mesh, const std::vector<std::uint32_t>& weld,
                                                const std::vector<float>& crease_angles) {
    const std::vector<glm::dvec3> areas = area_vectors(mesh);
    const std::vector<glm::vec3> smooth = smooth_normals(mesh, weld);
    const CornerTable table = corners_by_vertex(mesh, weld);
    std::vector<glm::uvec3> triangles(mesh.triangles.size());
    std::vector<std::uint32_t> source;  // new vertex -> old vertex
    std::vector<glm::vec3> normals;
    std::vector<Corner> corners;
    std::vector<Spoke> spokes;
    for (std::size_t v = 0; v + 1 < table.first.size(); ++v) {
        corners.clear();
        for (std::uint32_t i = table.first[v]; i < table.first[v + 1]; ++i)
            corners.push_back({table.corner[i] / 3, table.corner[i] % 3, static_cast<std::uint32_t>(corners.size())});
        const bool creased = crease_angles[v] < kPi;
        if (creased) {
            group_corners(mesh, weld, areas, std::cos(double(crease_angles[v])), corners, spokes);
        } else {
            for (Corner& corner : corners) corner.group = 0;
        }

        // One new vertex for each pair of group and old vertex.
        const auto old_vertex = [&](const Corner& c) { return mesh.triangles[c.triangle][int(c.slot)]; };
        std::sort(corners.begin(), corners.end(), [&](const Corner& a, const Corner& b) {
            return a.group != b.group ? a.group < b.group : old_vertex(a) < old_vertex(b);
        });
        for (std::size_t begin = 0, end; begin < corners.size(); begin = end) {
            glm::dvec3 sum(0.0);
            for (end = begin; end < corners.size() && corners[end].group == corners[begin].group; ++end)
                sum += areas[corners[end].triangle];
            const glm::vec3 normal = creased && usable(sum) ? glm::vec3(glm::normalize(sum)) : smooth[v];
            for (std::size_t i = begin; i < end; ++i) {
                if (i == begin || old_vertex(corners[i]) != old_vertex(corners[i - 1])) {
                    source.push_back(old_vertex(corners[i]));
                    normals.push_back(normal);
                }
                triangles[corners[i].triangle][int(corners[i].slot)] = static_cast<std::uint32_t>(source.size() - 1);
            }
        }
    }
    mesh.normals.clear();
    gather_vertices(mesh, source);
    mesh.normals = std::move(normals);
    mesh.triangles = std::move(triangles);
    return source;
}

}  // namespace

std::vector<std::uint32_t> make_normals(Mesh& mesh, float crease_angle) {
    const std::vector<std::uint32_t> weld = weld_positions(mesh.positions);
    const std::vector<float> angles = crease_angle == kCreasesByShell
                                          ? crease_angles(mesh, weld)
                                          : std::vector<float>(mesh.positions.size(), crease_angle);
    if (std::any_of(angles.begin(), angles.end(), [](float angle) { return angle < kPi; }))
        return make_creased_normals(mesh, weld, angles);
    const std::vector<glm::vec3> smooth = smooth_normals(mesh, weld);
    mesh.normals.resize(mesh.positions.size());
    for (std::size_t v = 0; v < weld.size(); ++v) mesh.normals[v] = smooth[weld[v]];
    std::vector<std::uint32_t> source(mesh.positions.size());
    std::iota(source.begin(), source.end(), 0u);
    return source;
}

std::size_t make_normals_valid(Mesh& mesh) {
    std::vector<std::size_t> bad;
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
        const glm::dvec3 n = mesh.normals[v];
        if (usable(n)) {
            mesh.normals[v] = glm::normalize(n);
        } else {
            bad.push_back(v);
        }
    }
    if (bad.empty()) return 0;
    const std::vector<std::uint32_t> weld = weld_positions(mesh.positions);
    const std::vector<glm::vec3> smooth = smooth_normals(mesh, weld);
    for (const std::size_t v : bad) mesh.normals[v] = smooth[weld[v]];
    return bad.size();
}

}  // namespace pellucid
