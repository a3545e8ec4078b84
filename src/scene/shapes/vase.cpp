#include "scene/shapes/shape_builders.h"

namespace pellucid {
namespace {

/// Control points from the middle of the underside to the middle of the inner bottom.
std::vector<glm::dvec2> control_points(double wall) {
    std::vector<glm::dvec2> points = {
        {0.000, -0.985}, {0.150, -0.985}, {0.240, -0.990}, {0.300, -1.000}, {0.340, -0.990}};
    const std::vector<glm::dvec2> body = {{0.360, -0.940}, {0.400, -0.780}, {0.490, -0.520}, {0.550, -0.240},
                                          {0.540, 0.060},  {0.450, 0.330},  {0.330, 0.540},  {0.270, 0.710},
                                          {0.285, 0.830},  {0.335, 0.910}};
    const glm::dvec2 rim(0.360, 1.0);
    points.insert(points.end(), body.begin(), body.end());
    points.insert(points.end(),
                  {{rim.x, rim.y - 0.5 * wall}, rim, {rim.x - wall, rim.y}, {rim.x - wall, rim.y - 0.5 * wall}});
    add_inside(points, body, rim, wall);
    points.insert(points.end(), {{0.300, -0.960 + wall}, {0.150, -0.985 + wall}, {0.000, -0.985 + wall}});
    return points;
}

/// Closes a half: the sections left and right of the axis, in the plane z = 0. The strip of triangles between both ends
/// of the profile advances on the side whose new edge is shorter.
void add_sections(Mesh& mesh, const std::vector<ProfilePoint>& profile) {
    for (const double side : {-1.0, 1.0}) {
        const unsigned first = unsigned(mesh.positions.size());
        for (const ProfilePoint& point : profile)
            add_vertex(mesh, {side * point.position.x, point.position.y, 0.0}, {0.0, 0.0, 1.0});
        const auto width = [&](std::size_t a, std::size_t b) {
            return glm::distance(profile[a].position, profile[b].position);
        };
        std::size_t outer = 0, inner = profile.size() - 1;
        while (inner - outer > 1) {
            const bool along_outer = width(outer + 1, inner) < width(outer, inner - 1);
            const std::size_t next = along_outer ? outer + 1 : inner - 1;
            glm::uvec3 triangle(first + outer, first + next, first + inner);
            if (side < 0.0) std::swap(triangle.y, triangle.z);
            mesh.triangles.push_back(triangle);
            (along_outer ? outer : inner) = next;
        }
    }
}

}  // namespace

Mesh make_vase(const ShapeArguments& arguments) {
    const std::vector<ProfilePoint> profile =
        spline_profile(control_points(arguments.number("wall")), arguments.whole("rings"));
    const bool half = arguments.whole("half") != 0;
    Mesh mesh = revolve(profile, arguments.whole("segments"), half);
    if (half) add_sections(mesh, profile);
    return mesh;
}

}  // namespace pellucid
