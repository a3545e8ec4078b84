#pragma once

#include <pellucid/api.h>
#include <pellucid/image.h>
#include <pellucid/progress.h>
#include <pellucid/reference.h>
#include <pellucid/refracted_path.h>
#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace pellucid {

/// An interface of glass that a view path meets.
struct PathSurface {
    std::int32_t object = -1;  ///< index into Scene::objects; -1: there is none
    glm::vec3 position{0.0f};  ///< world, m
    glm::vec3 normal{0.0f};    ///< unit, world, interpolated, out of the solid
};

/// A view path with its surfaces, and its transmittance by cause.
struct SurfacePath {
    RefractedPath path;
    PathSurface first, second, last;  ///< in the order of the path, total internal reflections included
    glm::vec3 attenuation{1.0f};      ///< RGB 0..1: share of the light that media leave
    float fresnel = 1.0f;             ///< 0..1: product of the Fresnel transmittances
};

/// Exact tracer of view paths and the surfaces that they meet. Same paths as Tracer::exact().
class PELLUCID_API SurfaceTracer {
public:
    /// Builds the hierarchy. `scene` must be checked (load_scene does it) and outlive the tracer. `threads` 0: all
    /// cores.
    explicit SurfaceTracer(const Scene& scene, std::uint32_t threads = 0);
    ~SurfaceTracer();
    SurfaceTracer(SurfaceTracer&&) noexcept;
    SurfaceTracer& operator=(SurfaceTracer&&) noexcept;

    /// One path per pixel, through its centre; rows from the top. Throws Error for settings or a camera out of range.
    std::vector<SurfacePath> trace(const Camera& camera, const ExactSettings& settings,
                                   const Progress& progress = {}) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Offset in pixels from each pixel's centre to the image of the point where its refracted path meets the background:
/// an opaque object, or the environment infinitely far away. Three channels: right, down, and 1 where there is such an
/// image. The offset is 0 where the path has no interface, and, as the third channel, where its end lies behind the
/// camera or the path was cut. `paths`: one per pixel of an image of `width` pixels, rows from the top. Throws Error for
/// another number of them, or a camera out of range.
PELLUCID_API Image refractive_flow(std::span<const RefractedPath> paths, const Camera& camera, std::uint32_t width,
                                   std::uint32_t height);

}  // namespace pellucid
