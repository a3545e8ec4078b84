#include "scene/shapes/shape_builders.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

/// Control points of the profile (distance from the axis, height) from the middle of the foot's
/// underside over foot, stem, outside of the bowl and rim to the bottom of the inside.
std::vector<glm::dvec2> control_points(double wall) {
    std::vector<glm::dvec2> points = {{0.000, -0.985}, {0.180, -0.985}, {0.380, -0.995}, {0.520, -1.000},
                                      {0.560, -0.998}, {0.575, -0.985}, {0.560, -0.965}, {0.440, -0.950},
                                      {0.240, -0.920}, {0.110, -0.860}, {0.062, -0.740}, {0.050, -0.560},
                                      {0.052, -0.380}, {0.068, -0.230}, {0.130, -0.130}};
    const std::vector<glm::dvec2> bowl = {{0.270, -0.060}, {0.420, 0.070}, {0.530, 0.260},
                                          {0.570, 0.480},  {0.545, 0.700}, {0.490, 0.880}};
    const double rim = 0.475;
    points.insert(points.end(), bowl.begin(), bowl.end());
    points.insert(points.end(), {{rim, 1.0 - wall}, {rim, 1.0}, {rim - wall, 1.0}, {rim - wall, 1.0 - wall}});
    // The inside follows the outside at the distance of the wall.
    for (std::size_t i = bowl.size(); i-- > 1;) {
        const glm::dvec2 before = bowl[i - 1];
        const glm::dvec2 after = i + 1 < bowl.size() ? bowl[i + 1] : glm::dvec2(rim, 1.0);
        const glm::dvec2 along = glm::normalize(after - before);
        points.push_back(bowl[i] - wall * glm::dvec2(along.y, -along.x));
    }
    points.push_back({0.220, -0.035 + wall});
    points.push_back({0.090, -0.075 + wall});
    points.push_back({0.000, -0.080 + wall});
    return points;
}

/// A uniform cubic B-spline that meets the axis at right angles at both ends.
class AxisToAxisSpline {
public:
    explicit AxisToAxisSpline(const std::vector<glm::dvec2>& points) {
        // Mirrored neighbours beyond the ends put the ends on the axis exactly and level.
        control_.push_back({-points[1].x, points[1].y});
        control_.insert(control_.end(), points.begin(), points.end());
        const glm::dvec2 last = points[points.size() - 2];
        control_.push_back({-last.x, last.y});
    }

    double end() const { return double(control_.size() - 3); }

    /// t in 0..end()
    ProfilePoint at(double t) const {
        const std::size_t span = std::min(std::size_t(t), control_.size() - 4);
        const double u = t - double(span), w = 1.0 - u;
        const glm::dvec2* p = &control_[span];
        const glm::dvec2 position = (w * w * w * p[0] + (3.0 * u * u * u - 6.0 * u * u + 4.0) * p[1] +
                                     (3.0 * w * w * w - 6.0 * w * w + 4.0) * p[2] + u * u * u * p[3]) /
                                    6.0;
        const glm::dvec2 tangent =
            w * w * (p[1] - p[0]) + (1.0 + 2.0 * u - 2.0 * u * u) * (p[2] - p[1]) + u * u * (p[3] - p[2]);
        return {position, glm::normalize(glm::dvec2(tangent.y, -tangent.x))};
    }

private:
    std::vector<glm::dvec2> control_;
};

/// `count` points from end to end, closer where the profile bends: equal shares of the sum of
/// length and turning, each in units of its total.
std::vector<ProfilePoint> sampled(const AxisToAxisSpline& spline, int count) {
    constexpr int kFineCount = 8192;
    const auto parameter = [&](double i) { return spline.end() * i / (kFineCount - 1); };
    std::vector<glm::dvec2> travelled{{0.0, 0.0}};  // length, turning
    ProfilePoint before = spline.at(0.0);
    for (int i = 1; i < kFineCount; ++i) {
        const ProfilePoint point = spline.at(parameter(i));
        const double turning = std::acos(std::min(glm::dot(before.normal, point.normal), 1.0));
        travelled.push_back(travelled.back() + glm::dvec2(glm::distance(before.position, point.position), turning));
        before = point;
    }
    std::vector<double> measure;
    for (const glm::dvec2 way : travelled)
        measure.push_back(0.5 * (way.x / travelled.back().x + way.y / travelled.back().y));

    std::vector<ProfilePoint> points{spline.at(0.0)};
    for (int k = 1; k + 1 < count; ++k) {
        const double target = double(k) / (count - 1);
        const auto above = std::ranges::lower_bound(measure, target);
        const double fraction = (target - above[-1]) / (above[0] - above[-1]);
        points.push_back(spline.at(parameter(double(above - measure.begin() - 1) + fraction)));
    }
    points.push_back(spline.at(spline.end()));
    return points;
}

}  // namespace

Mesh make_goblet(const ShapeArguments& arguments) {
    const AxisToAxisSpline profile(control_points(arguments.number("wall")));
    // Rings of quads and the two fans lie between rings + 1 points.
    return revolve(sampled(profile, arguments.whole("rings") + 1), arguments.whole("segments"));
}

}  // namespace pellucid
