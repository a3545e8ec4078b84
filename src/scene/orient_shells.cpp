// Inside and outside of a mesh with several shells.
#include "scene/orient_shells.h"

#include "scene/mesh_repair.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace pellucid {
namespace {

/// Samples of an inward shell for the winding number of the other shells: its farthest corners in kDirections
/// directions, and kTriangles triangles.
constexpr std::size_t kDirections = 26, kTriangles = 32;
constexpr double kApart = 1e-5;  // distance of a sample from the shell, relative to the shell's size

struct Shell {
    std::vector<std::uint32_t> triangles;  ///< indices into Mesh::triangles
    std::vector<glm::uvec3> corners;       ///< corners of each triangle, indices into Mesh::positions
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};
    bool closed = true;
    bool inward = false;
};

std::vector<Shell> list_shells(const Mesh& mesh, const Shells& found) {
    std::vector<Shell> shells(found.count());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        Shell& shell = shells[found.of_triangle[t]];
        shell.triangles.push_back(t);
        shell.corners.push_back(mesh.triangles[t]);
        for (int k = 0; k < 3; ++k) {
            shell.low = glm::min(shell.low, glm::dvec3(mesh.positions[mesh.triangles[t][k]]));
            shell.high = glm::max(shell.high, glm::dvec3(mesh.positions[mesh.triangles[t][k]]));
        }
    }
    for (std::uint32_t s = 0; s < found.count(); ++s) shells[s].closed = found.closed[s] != 0;
    return shells;
}

/// Winding number of the shell around a point; its sign depends on the shell's orientation.
double shell_winding(const Mesh& mesh, const Shell& shell, const glm::dvec3& point) {
    double sum = 0.0;
    for (const glm::uvec3 t : shell.corners)
        sum += winding_number(glm::dvec3(mesh.positions[t.x]) - point, glm::dvec3(mesh.positions[t.y]) - point,
                              glm::dvec3(mesh.positions[t.z]) - point);
    return sum;
}

/// True if another shell encloses the point. The other shell's orientation is ignored, as it may be wrong too.
bool enclosed(const Mesh& mesh, const std::vector<Shell>& shells, const Shell& own, const glm::dvec3& point) {
    return std::any_of(shells.begin(), shells.end(), [&](const Shell& other) {
        if (&other == &own || !other.closed) return false;
        if (glm::any(glm::lessThan(point, other.low)) || glm::any(glm::greaterThan(point, other.high))) return false;
        return std::abs(shell_winding(mesh, other, point)) > 0.5;
    });
}

/// Points just outside an inward shell: first at its extreme corners, then on its triangles.
std::vector<glm::dvec3> probes(const Mesh& mesh, const Shell& shell) {
    const double apart = kApart * glm::length(shell.high - shell.low);
    struct Extreme {
        std::size_t triangle = 0;
        int corner = 0;
        double along = -std::numeric_limits<double>::infinity();
    };
    std::vector<glm::dvec3> directions;  // directions on a spiral from pole to pole
    for (std::size_t d = 0; d < kDirections; ++d) {
        const double z = 1.0 - (2.0 * double(d) + 1.0) / double(kDirections), r = std::sqrt(1.0 - z * z);
        const double turn = double(d) * std::numbers::pi * (3.0 - std::sqrt(5.0));
        directions.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
    }
    std::vector<Extreme> farthest(kDirections);
    for (std::size_t i = 0; i < shell.corners.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 p = mesh.positions[shell.corners[i][k]];
            for (std::size_t d = 0; d < kDirections; ++d)
                if (const double along = glm::dot(p, directions[d]); along > farthest[d].along)
                    farthest[d] = {i, k, along};
        }
    }
    std::vector<glm::dvec3> points;
    const auto outside = [&](std::size_t triangle, const glm::dvec3& p) {
        const glm::uvec3 t = shell.corners[triangle];
        const glm::dvec3 a = mesh.positions[t.x];
        const glm::dvec3 inward = glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
        const double length = glm::length(inward);
        return length > 0.0 ? p - apart / length * inward : p;
    };
    for (const Extreme& c : farthest)
        points.push_back(outside(c.triangle, mesh.positions[shell.corners[c.triangle][c.corner]]));
    const std::size_t step = std::max<std::size_t>(shell.corners.size() / kTriangles, 1);
    for (std::size_t i = 0; i < shell.corners.size(); i += step) {
        const glm::uvec3 t = shell.corners[i];
        const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        for (const glm::dvec3& p : {(a + b + c) / 3.0, a, 0.5 * (a + b)}) points.push_back(outside(i, p));
    }
    return points;
}

bool is_cavity(const Mesh& mesh, const std::vector<Shell>& shells, const Shell& own) {
    const auto inside = [&](const Shell& other) {
        return &other != &own && other.closed && glm::all(glm::lessThanEqual(other.low, own.high)) &&
               glm::all(glm::lessThanEqual(own.low, other.high));
    };
    if (std::none_of(shells.begin(), shells.end(), inside)) return false;
    const std::vector<glm::dvec3> points = probes(mesh, own);
    return std::all_of(points.begin(), points.end(),
                       [&](const glm::dvec3& point) { return enclosed(mesh, shells, own, point); });
}

/// Reverses shells, and those normals that other shells' triangles do not share.
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
        if (in_turned[v] != 0 && elsewhere[v] == 0) turn_normal(mesh, v);
}

}  // namespace

double winding_number(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    return std::atan2(glm::dot(a, glm::cross(b, c)),
                      la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb) /
           (2.0 * std::numbers::pi);
}

TurnedShells orient_shells(Mesh& mesh, const Shells& found) {
    std::vector<Shell> shells = list_shells(mesh, found);
    std::vector<const Shell*> turned;
    std::vector<glm::uvec3> open;
    for (Shell& shell : shells) {
        shell.inward = shell.closed && signed_volume(mesh.positions, shell.corners).value < 0.0;
        if (!shell.closed) open.insert(open.end(), shell.corners.begin(), shell.corners.end());
    }
    for (const Shell& shell : shells)
        if (shell.inward && !is_cavity(mesh, shells, shell)) turned.push_back(&shell);
    TurnedShells result{.closed = turned.size()};
    const SignedVolume volume = signed_volume(mesh.positions, open);
    result.open = volume.value < 0.0 && volume.meaningful();
    for (const Shell& shell : shells)
        if (result.open && !shell.closed) turned.push_back(&shell);
    turn(mesh, turned);
    return result;
}

}  // namespace pellucid
