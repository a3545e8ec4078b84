// Solids as signed distance fields, and rays through them: Hart, "Sphere Tracing: A Geometric Method for the
// Antialiased Ray Tracing of Implicit Surfaces", The Visual Computer 1996.
#include "reference/camera_rays.h"
#include "reference/picture_tiles.h"
#include "scene/check_scene.h"

#include <pellucid/error.h>
#include <pellucid/exact_thickness.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace pellucid {
namespace {

using namespace reference;

constexpr double kSurfaceTolerance = 1e-9;  // relative to the solid's radius

/// Distance between `start` and `end` at which the ray comes within `tolerance` of the surface. A step is at least the
/// tolerance, so that the march does not stall past a grazed surface.
std::optional<double> march(const DistanceField& field, const glm::dvec3& origin, const glm::dvec3& direction,
                            double start, double end, double tolerance) {
    double t = start;
    while (t < end) {
        const double distance = field(origin + t * direction);
        if (distance < tolerance) return t;
        t += std::max(distance, tolerance);
    }
    return std::nullopt;
}

}  // namespace

DistanceField distance_to(std::vector<Ball> balls) {
    return [balls = std::move(balls)](const glm::dvec3& at) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Ball& ball : balls) nearest = std::min(nearest, glm::distance(at, ball.center) - ball.radius);
        return nearest;
    };
}

double marched_thickness(const DistanceField& field, const glm::dvec3& from, const glm::dvec3& to, double tolerance) {
    const double length = glm::distance(from, to);
    if (!(length > 0.0)) return 0.0;
    const glm::dvec3 direction = (to - from) / length;
    double solid = 0.0;
    for (double t = 0.0; t < length;) {
        const double distance = field(from + t * direction);
        const double step = std::min(std::max(std::abs(distance), tolerance), length - t);
        if (distance < 0.0) solid += step;
        t += step;
    }
    return solid;
}

Image march_thickness(const DistanceField& field, const Bounds& bounds, const Camera& camera, std::uint32_t width,
                      std::uint32_t height, const glm::dvec3& light_direction, std::uint32_t threads) {
    check_camera(camera);
    if (width == 0 || height == 0) throw Error(fmt::format("a picture of {}x{} has no pixels", width, height));
    const CameraRays rays(camera, width, height);
    const double radius = double(bounds.radius), tolerance = kSurfaceTolerance * radius;
    const glm::dvec3 center(bounds.center), way = glm::normalize(light_direction);
    Image thickness(int(width), int(height), 1);
    for_each_tile({width, height}, threads, [&](glm::uvec2 first, glm::uvec2 end) {
        for (std::uint32_t y = first.y; y < end.y; ++y) {
            for (std::uint32_t x = first.x; x < end.x; ++x) {
                float& value = *thickness.at(int(x), int(y));
                value = kNotTranslucent;
                const CameraRay ray = rays.at(glm::dvec2(x, y) + 0.5);
                const double middle = glm::dot(center - ray.origin, ray.direction);
                const auto seen = march(field, ray.origin, ray.direction, std::max(middle - 1.01 * radius, 0.0),
                                        std::min(middle + 1.01 * radius, ray.t_max), tolerance);
                if (!seen) continue;
                const glm::dvec3 point = ray.origin + *seen * ray.direction;
                const double before = glm::dot(point - center, way) + 1.01 * radius;
                value = float(marched_thickness(field, point - before * way, point, tolerance));
            }
        }
    });
    return thickness;
}

}  // namespace pellucid
