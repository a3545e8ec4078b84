#include "scene/shapes/profiles.h"
#include "scene/shapes/shape_builders.h"

namespace pellucid {
namespace {

/// Control points of the profile (distance from the axis, height). They run from the middle of the foot's underside
/// over foot, stem, outside of the bowl and rim to the bottom of the inside.
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
    add_inside(points, bowl, {rim, 1.0}, wall);
    points.push_back({0.220, -0.035 + wall});
    points.push_back({0.090, -0.075 + wall});
    points.push_back({0.000, -0.080 + wall});
    return points;
}

}  // namespace

std::vector<glm::dvec2> goblet_outline(double wall, int rings) {
    std::vector<glm::dvec2> outline;
    for (const ProfilePoint& point : spline_profile(control_points(wall), rings)) outline.push_back(point.position);
    return outline;
}

Mesh make_goblet(const ShapeArguments& arguments) {
    return revolve(spline_profile(control_points(arguments.number("wall")), arguments.whole("rings")),
                   arguments.whole("segments"));
}

}  // namespace pellucid
