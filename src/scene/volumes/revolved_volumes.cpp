// Volumes from surfaces of revolution.
#include "scene/shapes/profiles.h"
#include "scene/volumes/volume_building.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

/// Signed distances (positive outside) to a closed outline in the half plane (distance from the axis, height),
/// tabulated on a grid and interpolated linearly.
class OutlineDistance {
public:
    OutlineDistance(const std::vector<glm::dvec2>& outline, glm::dvec2 low, glm::dvec2 high, double spacing)
        : low_(low), spacing_(spacing), width_(int((high.x - low.x) / spacing) + 2),
          height_(int((high.y - low.y) / spacing) + 2) {
        values_.resize(std::size_t(width_) * std::size_t(height_));
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x)
                values_[std::size_t(y) * std::size_t(width_) + std::size_t(x)] =
                    exact(outline, low + spacing * glm::dvec2(x, y));
    }

    double operator()(glm::dvec2 at) const {
        const glm::dvec2 position =
            glm::clamp((at - low_) / spacing_, glm::dvec2(0.0), glm::dvec2(width_ - 1.001, height_ - 1.001));
        const glm::ivec2 corner(position);
        const glm::dvec2 w = position - glm::dvec2(corner);
        const auto value = [&](int x, int y) {
            return values_[std::size_t(corner.y + y) * std::size_t(width_) + std::size_t(corner.x + x)];
        };
        return glm::mix(glm::mix(value(0, 0), value(1, 0), w.x), glm::mix(value(0, 1), value(1, 1), w.x), w.y);
    }

private:
    static double exact(const std::vector<glm::dvec2>& outline, glm::dvec2 p) {
        double squared = 1e30;
        bool inside = false;
        for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
            const glm::dvec2 a = outline[i], way = outline[i + 1] - a;
            const double t = std::clamp(glm::dot(p - a, way) / std::max(glm::dot(way, way), 1e-30), 0.0, 1.0);
            const glm::dvec2 off = p - a - t * way;
            squared = std::min(squared, glm::dot(off, off));
            // Test a ray away from the axis. The axis is not part of the outline.
            if ((a.y > p.y) != (outline[i + 1].y > p.y) && p.x < a.x + (p.y - a.y) / way.y * way.x) inside = !inside;
        }
        return (inside ? -1.0 : 1.0) * std::sqrt(squared);
    }

    glm::dvec2 low_;
    double spacing_;
    int width_, height_;
    std::vector<double> values_;
};

}  // namespace

Volume make_wine_glass(const ShapeArguments& arguments) {
    const std::vector<glm::dvec2> outline = goblet_outline(arguments.number("wall"), 400);
    glm::dvec2 high(0.0), low(0.0, 1e30);
    for (const glm::dvec2 p : outline) high = glm::max(high, p), low = glm::min(low, p);
    const double margin = 0.04;
    Volume volume = empty_grid({-high.x - margin, low.y - margin, -high.x - margin},
                               {high.x + margin, high.y + margin, high.x + margin}, arguments.whole("resolution"), 15);
    const OutlineDistance distance(outline, {0.0, low.y - 2.0 * margin}, high + 4.0 * margin,
                                   0.5 * double(volume.voxel));
    fill_solid(volume, arguments, [&](glm::dvec3 x) { return distance({std::hypot(x.x, x.z), x.y}); });
    return volume;
}

}  // namespace pellucid
