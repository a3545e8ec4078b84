// Thickness of solid between a light and the visible point, by Embree rays; see ThicknessTracer.
#include "reference/camera_rays.h"
#include "reference/geometry.h"
#include "reference/picture_tiles.h"
#include "reference/punctual_lights.h"
#include "scene/check_scene.h"

#include <pellucid/error.h>
#include <pellucid/exact_thickness.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <vector>

namespace pellucid {
namespace {

using namespace reference;

/// A surface between the visible point and the light.
struct OnTheWay {
    double distance;  ///< m from the point
    bool entering;    ///< the light enters a solid at this surface
};

/// Length of solid in front of a point at distance 0. `leaving`: the light leaves a solid at the point itself.
double solid_before(const std::vector<OnTheWay>& towards_light, bool leaving) {
    double solid = 0.0, entry = 0.0;
    int entered = 0;
    for (auto surface = towards_light.rbegin(); surface != towards_light.rend(); ++surface) {
        if (surface->entering) {
            if (entered++ == 0) entry = surface->distance;
        } else if (entered > 0 && --entered == 0) {
            solid += entry - surface->distance;
        }
    }
    // An entry without an exit before the point belongs to the point's own surface or to an open mesh.
    return leaving && entered > 0 ? solid + entry : solid;
}

}  // namespace

struct ThicknessTracer::Impl {
    Impl(const Scene& scene_, std::uint32_t threads_)
        : scene(scene_), threads(threads_), geometry(scene_, TracerOptions{.threads = threads_}) {}

    bool translucent(std::uint32_t object) const { return geometry.material(object).translucent(); }
    float at(const CameraRay& ray, const Light& light) const;

    const Scene& scene;
    std::uint32_t threads;
    Geometry geometry;
};

float ThicknessTracer::Impl::at(const CameraRay& ray, const Light& light) const {
    Query query;
    query.origin = ray.origin;
    query.direction = ray.direction;
    query.t_max = ray.t_max;
    query.kinds = only(SurfaceKind::kOpaque);
    Hit hit = geometry.intersect(query);
    if (!hit.found || !translucent(hit.crossing.object)) return kNotTranslucent;
    const std::optional<ArrivingLight> arriving = arriving_from_center(light, hit.position);
    if (!arriving) return kNotTranslucent;
    const bool leaving = crossing_sense(-arriving->direction, hit.normal) == Sense::kLeaving;

    std::vector<Crossing> standing;
    std::vector<OnTheWay> surfaces;
    double travelled = 0.0;
    query.direction = arriving->direction;
    while (hit.found) {
        if (standing.empty())
            standing.push_back(hit.crossing);
        else
            geometry.step_onto(hit, standing);
        for (Crossing& on : standing) on.sense = geometry.sense(on.object, on.triangle, query.direction);
        query.origin = hit.position;
        query.t_max = arriving->distance - travelled;
        query.standing = standing;
        hit = geometry.intersect(query);
        if (!hit.found) break;
        if (!translucent(hit.crossing.object)) return kShadowed;
        travelled += hit.t;
        surfaces.push_back({travelled, crossing_sense(-query.direction, hit.normal) == Sense::kEntering});
    }
    return float(solid_before(surfaces, leaving));
}

ThicknessTracer::ThicknessTracer(const Scene& scene, std::uint32_t threads) : impl_(new Impl(scene, threads)) {}
ThicknessTracer::~ThicknessTracer() = default;
ThicknessTracer::ThicknessTracer(ThicknessTracer&&) noexcept = default;
ThicknessTracer& ThicknessTracer::operator=(ThicknessTracer&&) noexcept = default;

Image ThicknessTracer::trace(const Camera& camera, std::uint32_t width, std::uint32_t height, std::uint32_t light,
                             const Progress& progress) const {
    check_camera(camera);
    if (width == 0 || height == 0) throw Error(fmt::format("a picture of {}x{} has no pixels", width, height));
    if (light >= impl_->scene.lights.size())
        throw Error(fmt::format("there is no light {}; the scene has {}", light, impl_->scene.lights.size()));
    const CameraRays rays(camera, width, height);
    Image thickness(int(width), int(height), 1);
    std::mutex mutex;
    std::uint32_t done = 0;
    for_each_tile({width, height}, impl_->threads, [&](glm::uvec2 first, glm::uvec2 end) {
        for (std::uint32_t y = first.y; y < end.y; ++y) {
            for (std::uint32_t x = first.x; x < end.x; ++x)
                *thickness.at(int(x), int(y)) = impl_->at(rays.at(glm::dvec2(x, y) + 0.5), impl_->scene.lights[light]);
        }
        if (!progress) return;
        const std::lock_guard lock(mutex);
        progress(double(++done) / double(tile_count({width, height})));
    });
    return thickness;
}

}  // namespace pellucid
