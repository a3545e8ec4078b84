#include "reference/exact_refraction.h"
#include "scene/check_scene.h"

#include <pellucid/error.h>
#include <pellucid/path_surfaces.h>

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace pellucid {
namespace {

using namespace reference;

/// Position in pixels of a point (w = 1) or a direction (w = 0) of the world; none behind the camera.
std::optional<glm::dvec2> image_of(const glm::dvec4& end, const Camera& camera, const glm::dmat4& view_from_world,
                                   glm::dvec2 size) {
    const glm::dvec4 in_view = view_from_world * end;
    if (!(in_view.z < 0.0)) return std::nullopt;
    if (camera.orthographic && end.w == 0.0) return std::nullopt;
    const double extent =
        camera.orthographic ? double(camera.vertical_extent) : 2.0 * std::tan(0.5 * double(camera.vertical_fov));
    const glm::dvec2 film = camera.orthographic ? glm::dvec2(in_view) : glm::dvec2(in_view) / -in_view.z;
    const glm::dvec2 pixel = 0.5 * size + film * glm::dvec2(1.0, -1.0) * (size.y / extent);
    // Ends at the horizon of the camera are farther than a float can hold.
    constexpr double kFarthest = 1e6;
    if (!(std::abs(pixel.x) < kFarthest && std::abs(pixel.y) < kFarthest)) return std::nullopt;
    return pixel;
}

}  // namespace

struct SurfaceTracer::Impl {
    Impl(const Scene& scene, std::uint32_t threads_)
        : threads(threads_), geometry(scene, TracerOptions{.threads = threads_}), volumes(scene, geometry) {}

    std::uint32_t threads;
    Geometry geometry;
    CurvedVolumes volumes;
};

SurfaceTracer::SurfaceTracer(const Scene& scene, std::uint32_t threads) : impl_(new Impl(scene, threads)) {}
SurfaceTracer::~SurfaceTracer() = default;
SurfaceTracer::SurfaceTracer(SurfaceTracer&&) noexcept = default;
SurfaceTracer& SurfaceTracer::operator=(SurfaceTracer&&) noexcept = default;

std::vector<SurfacePath> SurfaceTracer::trace(const Camera& camera, const ExactSettings& settings,
                                              const Progress& progress) const {
    return trace_surfaces(impl_->geometry, impl_->volumes, camera, settings, impl_->threads, progress);
}

Image refractive_flow(std::span<const RefractedPath> paths, const Camera& camera, std::uint32_t width,
                      std::uint32_t height) {
    check_camera(camera);
    if (paths.size() != std::size_t(width) * height)
        throw Error(fmt::format("{} paths are not those of an image of {}x{}", paths.size(), width, height));
    const glm::dmat4 view_from_world = glm::inverse(glm::dmat4(camera.world_from_view));
    Image flow{int(width), int(height), 3};
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const RefractedPath& path = paths[i];
        float* to = &flow.pixels[3 * i];
        to[2] = 1.0f;
        if (path.events == 0) continue;
        const glm::dvec4 end = path.object >= 0 ? glm::dvec4(path.position, 1.0) : glm::dvec4(path.direction, 0.0);
        const auto image = path.status == Status::kOk ? image_of(end, camera, view_from_world, {width, height})
                                                      : std::optional<glm::dvec2>();
        if (image) {
            to[0] = float(image->x - (double(i % width) + 0.5));
            to[1] = float(image->y - (double(i / width) + 0.5));
        } else {
            to[2] = 0.0f;
        }
    }
    return flow;
}

}  // namespace pellucid
