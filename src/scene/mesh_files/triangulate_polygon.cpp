#include "scene/mesh_files/triangulate_polygon.h"

#include <cmath>

namespace pellucid {
namespace {

constexpr std::size_t kMostTests = 50000000;  // of a corner against an ear: 0.3 s

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

double area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Newell's normal, as long as twice the area (Sutherland, Sproull & Schumacker, "A characterization of ten
/// hidden-surface algorithms", ACM Computing Surveys 6, 1974).
glm::dvec3 newell_normal(std::span<const glm::dvec3> corners) {
    glm::dvec3 normal(0.0);
    for (std::size_t i = 0; i < corners.size(); ++i)
        normal += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
    return normal;
}

/// The corners in the plane of the polygon, counter-clockwise.
std::vector<glm::dvec2> flattened(std::span<const glm::dvec3> corners, const glm::dvec3& normal) {
    const glm::dvec3 n = glm::normalize(normal);
    const glm::dvec3 other = std::abs(n.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 u = glm::normalize(glm::cross(other, n)), v = glm::cross(n, u);
    std::vector<glm::dvec2> flat;
    flat.reserve(corners.size());
    for (const glm::dvec3& p : corners) flat.emplace_back(glm::dot(p - corners[0], u), glm::dot(p - corners[0], v));
    return flat;
}

class EarCutter {
public:
    EarCutter(const std::vector<glm::dvec2>& corners, std::vector<std::uint32_t> names)
        : corners_(corners), names_(std::move(names)), left_(corners.size()) {
        for (std::uint32_t i = 0; i < left_.size(); ++i) left_[i] = i;
    }

    Triangles cut() {
        Triangles triangles;
        std::size_t at = 0, without_ear = 0;
        while (left_.size() > 3) {
            // A polygon that crosses itself may have no ear left, and takes long to show it: what is left is then a fan.
            if (without_ear > left_.size() || tests_ > kMostTests) break;
            if (is_ear(at)) {
                triangles.push_back(triangle(at));
                left_.erase(left_.begin() + std::ptrdiff_t(at % left_.size()));
                without_ear = 0;
                // Go on beyond the ear's neighbour: fans of slivers come from going on next to it.
                ++at;
            } else {
                ++at;
                ++without_ear;
            }
            at %= left_.size();
        }
        for (std::size_t i = 1; i + 1 < left_.size(); ++i)
            triangles.push_back({names_[left_[0]], names_[left_[i]], names_[left_[i + 1]]});
        return triangles;
    }

private:
    std::uint32_t corner(std::size_t at) const { return left_[at % left_.size()]; }

    std::array<std::uint32_t, 3> triangle(std::size_t at) const {
        return {names_[corner(at + left_.size() - 1)], names_[corner(at)], names_[corner(at + 1)]};
    }

    bool is_ear(std::size_t at) {
        const std::uint32_t ia = corner(at + left_.size() - 1), ib = corner(at), ic = corner(at + 1);
        const glm::dvec2 &a = corners_[ia], &b = corners_[ib], &c = corners_[ic];
        if (!(area(a, b, c) > 0.0)) return false;
        for (const std::uint32_t i : left_) {
            const glm::dvec2& p = corners_[i];
            // Bridges to holes have corners twice.
            ++tests_;
            if (i == ia || i == ib || i == ic || p == a || p == b || p == c) continue;
            if (area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0) return false;
        }
        return true;
    }

    const std::vector<glm::dvec2>& corners_;
    std::vector<std::uint32_t> names_;
    std::vector<std::uint32_t> left_;
    std::size_t tests_ = 0;
};

bool convex(const std::vector<glm::dvec2>& corners) {
    double turns = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec2 &a = corners[i], &b = corners[(i + 1) % corners.size()],
                         &c = corners[(i + 2) % corners.size()];
        if (!(area(a, b, c) > 0.0)) return false;
        turns += std::atan2(area(a, b, c), glm::dot(b - a, c - b));
    }
    return turns < 6.5;  // once around, no star
}

}  // namespace

Triangles triangulate_polygon(std::span<const glm::dvec3> all) {
    std::vector<glm::dvec3> corners;
    std::vector<std::uint32_t> names;
    for (std::uint32_t i = 0; i < all.size(); ++i) {
        if (!corners.empty() && all[i] == corners.back()) continue;
        corners.push_back(all[i]);
        names.push_back(i);
    }
    while (corners.size() > 1 && corners.back() == corners.front()) corners.pop_back(), names.pop_back();
    if (corners.size() < 3) return {};
    if (corners.size() == 3) return {{names[0], names[1], names[2]}};
    const glm::dvec3 normal = newell_normal(corners);
    const bool flat = !(glm::length(normal) > 0.0) || !std::isfinite(glm::length(normal));
    const std::vector<glm::dvec2> plane = flat ? std::vector<glm::dvec2>() : flattened(corners, normal);
    if (!flat && !convex(plane)) return EarCutter(plane, std::move(names)).cut();
    Triangles fan;
    for (std::size_t i = 2; i < corners.size(); ++i) fan.push_back({names[0], names[i - 1], names[i]});
    return fan;
}

}  // namespace pellucid
