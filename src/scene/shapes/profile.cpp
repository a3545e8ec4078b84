#include "scene/shapes/shape_builders.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

/// A uniform cubic B-spline that meets the axis at right angles at both ends.
class AxisToAxisSpline {
public:
    explicit AxisToAxisSpline(const std::vector<glm::dvec2>& points) {
        // Mirrored neighbours beyond the ends place the ends exactly on the axis, with a horizontal tangent.
        control_.push_back({-points[1].x, points[1].y});
        control_.insert(control_.end(), points.begin(), points.end());
        const glm::dvec2 last = points[points.size() - 2];
        control_.push_back({-last.x, last.y});
    }

    double end() const { return double(control_.size() - 3); }

    /// `t`: 0..end().
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

/// `count` points from end to end, denser at bends: equal steps of the sum of length and turning, each normalised by
/// its total.
std::vector<ProfilePoint> sampled(const AxisToAxisSpline& spline, int count) {
    constexpr int kFineCount = 8192;
    const auto parameter = [&](double i) { return spline.end() * i / (kFineCount - 1); };
    std::vector<glm::dvec2> travelled{{0.0, 0.0}};  // cumulative length and turning
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

std::vector<ProfilePoint> spline_profile(const std::vector<glm::dvec2>& control_points, int rings) {
    // `rings` segments, including the two fans, lie between rings + 1 points.
    return sampled(AxisToAxisSpline(control_points), rings + 1);
}

void add_inside(std::vector<glm::dvec2>& points, const std::vector<glm::dvec2>& outside, glm::dvec2 end, double wall) {
    for (std::size_t i = outside.size(); i-- > 1;) {
        const glm::dvec2 before = outside[i - 1];
        const glm::dvec2 after = i + 1 < outside.size() ? outside[i + 1] : end;
        const glm::dvec2 along = glm::normalize(after - before);
        points.push_back(outside[i] - wall * glm::dvec2(along.y, -along.x));
    }
}

}  // namespace pellucid
