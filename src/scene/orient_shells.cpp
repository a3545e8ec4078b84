// Inside and outside of a mesh with several shells. Winding numbers are sums of solid angles: van Oosterom & Strackee,
// "The solid angle of a plane triangle", IEEE Transactions on Biomedical Engineering 30(2), 1983.
#include "scene/orient_shells.h"

#include "scene/mesh_edges.h"
#include "scene/mesh_repair.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace pellucid {
namespace {

/// Points of an inward shell at which the winding number of the other shells is computed.
constexpr std::size_t kProbes = 8;

struct Shell {
    std::vector<std::uint32_t> triangles;  ///< Mesh::triangles
    std::vector<glm::uvec3> corners;       ///< of each, Mesh::positions
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};
    bool closed = true;
    bool inward = false;
};

std::vector<Shell> shells_of(const Mesh& mesh, std::span<const std::uint32_t> weld) {
    const std::vector<HalfEdge> edges = sorted_half_edges(mesh.triangles, weld);
    DisjointSets sets(mesh.triangles.size());
    std::vector<std::uint32_t> open;
    for (std::size_t begin = 0, end; begin < edges.size(); begin = end) {
        int balance = 0;
        for (end = begin; end < edges.size() && edges[end].ends == edges[begin].ends; ++end) {
            balance += edges[end].forward ? 1 : -1;
            sets.join(edges[end].triangle, edges[begin].triangle);
        }
        if (balance != 0) open.push_back(edges[begin].triangle);
    }
    std::vector<std::uint32_t> shell_at(mesh.triangles.size(), std::numeric_limits<std::uint32_t>::max());
    std::vector<Shell> shells;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        std::uint32_t& number = shell_at[sets.root(t)];
        if (number == std::numeric_limits<std::uint32_t>::max()) {
            number = std::uint32_t(shells.size());
            shells.emplace_back();
        }
        Shell& shell = shells[number];
        shell.triangles.push_back(t);
        shell.corners.push_back(mesh.triangles[t]);
        for (int k = 0; k < 3; ++k) {
            shell.low = glm::min(shell.low, glm::dvec3(mesh.positions[mesh.triangles[t][k]]));
            shell.high = glm::max(shell.high, glm::dvec3(mesh.positions[mesh.triangles[t][k]]));
        }
    }
    for (const std::uint32_t triangle : open) shells[shell_at[sets.root(triangle)]].closed = false;
    return shells;
}

/// How often the shell surrounds a point; the sign says which way round it is wound.
double winding_number(const Mesh& mesh, const Shell& shell, const glm::dvec3& point) {
    double angle = 0.0;
    for (const glm::uvec3 t : shell.corners) {
        const glm::dvec3 a = glm::dvec3(mesh.positions[t.x]) - point;
        const glm::dvec3 b = glm::dvec3(mesh.positions[t.y]) - point;
        const glm::dvec3 c = glm::dvec3(mesh.positions[t.z]) - point;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        angle += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                  la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return angle / (4.0 * std::numbers::pi);
}

/// Whether the other shells enclose a point. How these are wound does not matter: they may need turning, too.
bool enclosed(const Mesh& mesh, const std::vector<Shell>& shells, const Shell& own, const glm::dvec3& point) {
    return std::any_of(shells.begin(), shells.end(), [&](const Shell& other) {
        if (&other == &own || !other.closed) return false;
        if (glm::any(glm::lessThan(point, other.low)) || glm::any(glm::greaterThan(point, other.high))) return false;
        return std::abs(winding_number(mesh, other, point)) > 0.5;
    });
}

bool is_cavity(const Mesh& mesh, const std::vector<Shell>& shells, const Shell& own) {
    const std::size_t step = std::max<std::size_t>(own.triangles.size() / kProbes, 1);
    for (std::size_t i = 0; i < own.triangles.size(); i += step) {
        const glm::uvec3 t = own.corners[i];
        const glm::dvec3 middle =
            (glm::dvec3(mesh.positions[t.x]) + glm::dvec3(mesh.positions[t.y]) + glm::dvec3(mesh.positions[t.z])) / 3.0;
        if (!enclosed(mesh, shells, own, middle)) return false;
    }
    return true;
}

/// Normals follow, but for vertices that are shared with triangles of other shells.
void turn(Mesh& mesh, const std::vector<const Shell*>& turned) {
    if (turned.empty()) return;
    std::vector<char> in_turned(mesh.positions.size(), 0), elsewhere(mesh.positions.size(), 0);
    std::vector<char> turns(mesh.triangles.size(), 0);
    for (const Shell* shell : turned)
        for (const std::uint32_t t : shell->triangles) turns[t] = 1;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) (turns[t] != 0 ? in_turned : elsewhere)[mesh.triangles[t][k]] = 1;
        if (turns[t] != 0) std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
    }
    for (std::size_t v = 0; v < mesh.normals.size(); ++v)
        if (in_turned[v] != 0 && elsewhere[v] == 0) mesh.normals[v] = -mesh.normals[v];
}

}  // namespace

ShellOrientation orient_shells(Mesh& mesh, std::span<const std::uint32_t> weld) {
    std::vector<Shell> shells = shells_of(mesh, weld);
    std::vector<const Shell*> turned;
    if (shells.size() > 1) {
        for (Shell& shell : shells) shell.inward = shell.closed && signed_volume(mesh.positions, shell.corners).value < 0.0;
        for (const Shell& shell : shells)
            if (shell.inward && !is_cavity(mesh, shells, shell)) turned.push_back(&shell);
        turn(mesh, turned);
    }
    const bool all_closed = std::all_of(shells.begin(), shells.end(), [](const Shell& shell) { return shell.closed; });
    return {shells.size(), turned.size(), all_closed};
}

}  // namespace pellucid
