#include "scene/crease_angles.h"

#include "core/math.h"
#include "scene/mesh_edges.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

constexpr float kLowestGap = 25.0f, kGapWidth = 15.0f, kHighestGapEnd = 90.0f;  // degrees
constexpr float kFold = 150.0f;  // degrees; larger angles are folds of double sheets, not creases
constexpr std::size_t kAboveByInside = 10;

/// Shell of each welded vertex, named by one of its vertices.
std::vector<std::uint32_t> shells(const Mesh& mesh, const std::vector<std::uint32_t>& weld) {
    DisjointSets sets(weld.size());
    for (const glm::uvec3 t : mesh.triangles)
        for (int k = 1; k < 3; ++k) sets.join(weld[t[k]], weld[t.x]);
    std::vector<std::uint32_t> shell(weld.size());
    for (std::uint32_t v = 0; v < shell.size(); ++v) shell[v] = sets.root(v);
    return shell;
}

struct Bend {
    std::uint32_t shell;
    float degrees;
};

/// Bends of all edges between two triangles, ordered by shell and size.
std::vector<Bend> bends(const Mesh& mesh, const std::vector<std::uint32_t>& weld,
                        const std::vector<std::uint32_t>& shell) {
    const std::vector<HalfEdge> sides = sorted_half_edges(mesh.triangles, weld);
    const auto area = [&](std::uint32_t triangle) {
        const glm::uvec3 t = mesh.triangles[triangle];
        const glm::dvec3 a = mesh.positions[t.x];
        return glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
    };
    std::vector<Bend> result;
    for (std::size_t begin = 0, end; begin < sides.size(); begin = end) {
        for (end = begin; end < sides.size() && sides[end].ends == sides[begin].ends;) ++end;
        if (end - begin != 2) continue;
        const glm::dvec3 a = area(sides[begin].triangle), b = area(sides[begin + 1].triangle);
        const double scale = glm::length(a) * glm::length(b);
        if (!(scale > 0.0)) continue;
        const double angle = std::acos(std::clamp(glm::dot(a, b) / scale, -1.0, 1.0));
        result.push_back({shell[std::uint32_t(sides[begin].ends)], degrees_from_radians(float(angle))});
    }
    std::sort(result.begin(), result.end(), [](const Bend& a, const Bend& b) {
        return a.shell != b.shell ? a.shell < b.shell : a.degrees < b.degrees;
    });
    return result;
}

/// Crease angle in degrees; 180 without a gap.
float crease_angle(const Bend* begin, const Bend* end) {
    const auto first_from = [&](float degrees) {
        return std::lower_bound(begin, end, degrees, [](const Bend& bend, float d) { return bend.degrees < d; });
    };
    const Bend* const folds = first_from(kFold);
    const auto fewest = static_cast<std::size_t>(std::ceil(std::sqrt(double(end - begin))));
    for (float low = kLowestGap; low + kGapWidth < kHighestGapEnd; low += 1.0f) {
        const Bend* const high = first_from(low + kGapWidth);
        const auto inside = std::size_t(high - first_from(low));
        const auto above = std::size_t(folds - high);
        if (above >= fewest && inside * kAboveByInside <= above) return low + 0.5f * kGapWidth;
    }
    return 180.0f;
}

}  // namespace

std::vector<float> crease_angles(const Mesh& mesh, const std::vector<std::uint32_t>& weld) {
    const std::vector<std::uint32_t> shell = shells(mesh, weld);
    const std::vector<Bend> all = bends(mesh, weld, shell);
    std::vector<float> angles(weld.size(), kPi);
    for (std::size_t begin = 0, end; begin < all.size(); begin = end) {
        for (end = begin; end < all.size() && all[end].shell == all[begin].shell;) ++end;
        const float degrees = crease_angle(all.data() + begin, all.data() + end);
        angles[all[begin].shell] = degrees < 180.0f ? radians_from_degrees(degrees) : kPi;
    }
    for (std::size_t v = 0; v < angles.size(); ++v) angles[v] = angles[shell[v]];
    return angles;
}

}  // namespace pellucid
