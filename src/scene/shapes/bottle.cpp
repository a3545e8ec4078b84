#include "scene/shapes/shape_builders.h"

#include <cmath>

namespace pellucid {
namespace {

constexpr double kBodyRadius = 0.38, kGrooveDepth = 0.03;
constexpr double kGroovesBottom = -0.62, kGroovesTop = 0.16;
constexpr double kNeckRadius = 0.15;

/// Control points of the outside, from the foot to below the rim. add_inside() offsets them by the wall.
std::vector<glm::dvec2> outside(int grooves) {
    std::vector<glm::dvec2> points = {{0.350, -0.985}, {0.375, -0.940}, {kBodyRadius, -0.860}, {kBodyRadius, -0.740}};
    const double step = (kGroovesTop - kGroovesBottom) / (2.0 * grooves);
    for (int i = 0; i <= 2 * grooves; ++i)
        points.push_back({kBodyRadius - (i % 2 == 1 ? kGrooveDepth : 0.0), kGroovesBottom + step * i});
    points.insert(points.end(), {{kBodyRadius, 0.240},
                                 {0.365, 0.340},
                                 {0.320, 0.450},
                                 {0.245, 0.550},
                                 {0.180, 0.640},
                                 {kNeckRadius, 0.740},
                                 {kNeckRadius, 0.840},
                                 {kNeckRadius, 0.900}});
    return points;
}

/// Control points from the middle of the underside, which is raised as in most bottles, to the middle of the inner
/// bottom.
std::vector<glm::dvec2> control_points(int grooves, double wall) {
    std::vector<glm::dvec2> points = {
        {0.000, -0.900}, {0.090, -0.902}, {0.200, -0.935}, {0.270, -0.985}, {0.310, -1.0}};
    const std::vector<glm::dvec2> body = outside(grooves);
    points.insert(points.end(), body.begin(), body.end());
    const glm::dvec2 rim(kNeckRadius, 1.0);
    points.insert(points.end(), {{rim.x, rim.y - wall}, rim, {rim.x - wall, rim.y}, {rim.x - wall, rim.y - wall}});
    add_inside(points, body, rim, wall);
    points.insert(points.end(),
                  {{0.310, -0.975 + wall}, {0.200, -0.930 + wall}, {0.090, -0.902 + wall}, {0.000, -0.900 + wall}});
    return points;
}

}  // namespace

Mesh make_bottle(const ShapeArguments& arguments) {
    return revolve(
        spline_profile(control_points(arguments.whole("grooves"), arguments.number("wall")), arguments.whole("rings")),
        arguments.whole("segments"));
}

}  // namespace pellucid
