#include "scene/shell_windings.h"

#include "core/parallel.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid {
namespace {

constexpr double kSamples = 4096.0;       // samples per shell, distributed by area, besides one per triangle
constexpr double kPerCell = 2.0;          // triangles per cell, if each lay in one cell of the grid
constexpr std::size_t kMostCells = 2048;  // cells per side
constexpr double kUndecided = 1e-6;       // relative to the shell's size; closer surfaces make a sample undecided
constexpr std::uint32_t kConfirmed = 3;   // samples required to accept a winding number

/// Twice the signed area of three points.
double area_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

/// True if p lies to the left of a line. Exchanging the ends gives the opposite result, so triangles on both sides
/// agree.
bool left_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& p) {
    const bool swapped = a.x != b.x ? b.x < a.x : b.y < a.y;
    return swapped ? area_of(b, a, p) <= 0.0 : area_of(a, b, p) > 0.0;
}

/// One shell in a frame whose z axis is unlikely to align with the model. Winding numbers are counted along z.
class ShellLines {
public:
    ShellLines(std::span<const glm::vec3> positions, const std::vector<glm::uvec3>& triangles) {
        const glm::dmat3 turn = glm::mat3_cast(glm::normalize(glm::dquat(0.83, 0.31, -0.27, 0.38)));
        for (const glm::uvec3 t : triangles) {
            const Corners corners = {turn * glm::dvec3(positions[t.x]), turn * glm::dvec3(positions[t.y]),
                                     turn * glm::dvec3(positions[t.z])};
            triangles_.push_back(corners);
            for (const glm::dvec3& p : {corners.a, corners.b, corners.c}) {
                low_ = glm::min(low_, p);
                high_ = glm::max(high_, p);
            }
        }
        list_triangles();
    }

    WindingRange range() const {
        std::vector<double> areas;
        double all = 0.0;
        for (const Corners& t : triangles_) {
            areas.push_back(glm::length(glm::cross(t.b - t.a, t.c - t.a)));
            all += areas.back();
        }
        constexpr std::size_t kRun = 4096;
        const std::size_t runs = (triangles_.size() + kRun - 1) / kRun;
        std::vector<Counts> counts(runs);
        for_each_parallel(runs, [&](std::size_t run) {
            for (std::size_t t = run * kRun; t < std::min((run + 1) * kRun, triangles_.size()); ++t) {
                const auto samples = std::uint32_t(1.0 + (all > 0.0 ? kSamples * areas[t] / all : 0.0));
                for (std::uint32_t s = 0; s < samples; ++s) sample(t, s, counts[run]);
            }
        });
        WindingRange range{0, 0};
        Counts sum;
        for (const Counts& own : counts)
            for (int w = 0; w < kCounted; ++w) sum.of[w] += own.of[w];
        for (int w = 0; w < kCounted; ++w) {
            if (sum.of[w] < kConfirmed) continue;
            range.least = std::min(range.least, w - kLowest);
            range.most = std::max(range.most, w - kLowest);
        }
        return range;
    }

private:
    struct Corners {
        glm::dvec3 a, b, c;
    };
    static constexpr int kLowest = 16, kCounted = 33;
    struct Counts {  ///< number of samples per winding number
        std::uint32_t of[kCounted] = {};
    };

    std::size_t cell(double at, int axis) const {
        const double size = high_[axis] - low_[axis];
        return size > 0.0 ? std::min(std::size_t(double(across_) * (at - low_[axis]) / size), across_ - 1) : 0;
    }

    template <class Visit>
    void for_each_cell(const Corners& t, const Visit& visit) const {
        const glm::dvec3 low = glm::min(t.a, glm::min(t.b, t.c)), high = glm::max(t.a, glm::max(t.b, t.c));
        for (std::size_t y = cell(low.y, 1); y <= cell(high.y, 1); ++y)
            for (std::size_t x = cell(low.x, 0); x <= cell(high.x, 0); ++x) visit(y * across_ + x);
    }

    void list_triangles() {
        across_ = std::clamp<std::size_t>(std::size_t(std::sqrt(double(triangles_.size()) / kPerCell)), 1, kMostCells);
        first_.assign(across_ * across_ + 1, 0);
        for (const Corners& t : triangles_) for_each_cell(t, [&](std::size_t cell) { ++first_[cell + 1]; });
        for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
        listed_.resize(first_.back());
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        for (std::uint32_t t = 0; t < triangles_.size(); ++t)
            for_each_cell(triangles_[t], [&](std::size_t cell) { listed_[next[cell]++] = t; });
    }

    /// Counts the winding numbers on both sides of a point of a triangle.
    void sample(std::size_t triangle, std::uint32_t number, Counts& counts) const {
        const Corners& own = triangles_[triangle];
        const double own_area = area_of(own.a, own.b, own.c);
        if (own_area == 0.0) return;
        // An additive recurrence (Roberts 2018), starting near the middle.
        double u = std::fmod(0.37 + 0.754877666 * number, 1.0), v = std::fmod(0.29 + 0.569840291 * number, 1.0);
        if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
        const glm::dvec3 p = own.a + u * (own.b - own.a) + v * (own.c - own.a);
        const double undecided = kUndecided * glm::length(high_ - low_);
        // winding number just beyond the triangle on a ray along z: +1 for each surface through which the ray leaves
        int ahead = 0;
        const std::size_t at = cell(p.y, 1) * across_ + cell(p.x, 0);
        for (std::size_t i = first_[at]; i < first_[at + 1]; ++i) {
            if (listed_[i] == triangle) continue;
            const Corners& t = triangles_[listed_[i]];
            const bool left = left_of(t.a, t.b, p);
            if (left_of(t.b, t.c, p) != left || left_of(t.c, t.a, p) != left) continue;
            const double area = area_of(t.a, t.b, t.c);
            if (area == 0.0) continue;
            const double z =
                (area_of(p, t.b, t.c) * t.a.z + area_of(t.a, p, t.c) * t.b.z + area_of(t.a, t.b, p) * t.c.z) / area;
            if (std::abs(z - p.z) <= undecided) return;
            if (z > p.z) ahead += left ? 1 : -1;
        }
        const int behind = ahead + (own_area > 0.0 ? 1 : -1);
        for (const int winding : {ahead, behind}) ++counts.of[std::clamp(winding, -kLowest, kLowest) + kLowest];
    }

    std::vector<Corners> triangles_;
    glm::dvec3 low_{std::numeric_limits<double>::infinity()}, high_{-std::numeric_limits<double>::infinity()};
    std::size_t across_ = 1;          ///< cells per side of a grid over x and y
    std::vector<std::size_t> first_;  ///< per cell, index of its first entry in listed_
    std::vector<std::uint32_t> listed_;
};

}  // namespace

std::vector<WindingRange> winding_ranges(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                                         const Shells& shells) {
    std::vector<std::vector<glm::uvec3>> of_shell(shells.count());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (shells.closed[shells.of_triangle[t]] != 0) of_shell[shells.of_triangle[t]].push_back(triangles[t]);
    std::vector<WindingRange> ranges(shells.count());
    for (std::uint32_t s = 0; s < shells.count(); ++s)
        if (shells.closed[s] != 0) ranges[s] = ShellLines(positions, of_shell[s]).range();
    return ranges;
}

}  // namespace pellucid
