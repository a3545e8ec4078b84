#pragma once

#include <pellucid/api.h>
#include <pellucid/image.h>
#include <pellucid/progress.h>
#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace pellucid {

/// Thickness values of pixels without a thickness.
/// the surface is not translucent, or lies outside the light's cone or range
inline constexpr float kNotTranslucent = -1.0f;
inline constexpr float kShadowed = -2.0f;  ///< an opaque object blocks the light

/// Exact thickness: an Embree ray from every visible point to the light, in double precision. The sides of the
/// triangles tell solids from gaps: a ray is inside a solid while its entries outnumber its exits. An entry without an
/// exit contributes no thickness.
class PELLUCID_API ThicknessTracer {
public:
    /// Builds the hierarchy. `scene` must be checked (load_scene does it) and outlive the tracer. `threads` 0: all
    /// cores.
    explicit ThicknessTracer(const Scene& scene, std::uint32_t threads = 0);
    ~ThicknessTracer();
    ThicknessTracer(ThicknessTracer&&) noexcept;
    ThicknessTracer& operator=(ThicknessTracer&&) noexcept;

    /// One channel: thickness of solid between the light and the visible point in m, kNotTranslucent or kShadowed.
    /// Throws Error if the light does not exist.
    Image trace(const Camera& camera, std::uint32_t width, std::uint32_t height, std::uint32_t light,
                const Progress& progress = {}) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Signed distance to a solid, m, negative inside. Its magnitude never exceeds the true distance.
using DistanceField = std::function<double(const glm::dvec3&)>;
/// A ball. Solids are unions of balls.
struct Ball {
    glm::dvec3 center{0.0};
    double radius = 1.0;
};
PELLUCID_API DistanceField distance_to(std::vector<Ball> balls);
/// Length of the part of the segment `from`..`to` inside the solid, by sphere tracing (Hart 1996, "Sphere Tracing").
/// `tolerance`: distance in m at which the surface counts as reached.
PELLUCID_API double marched_thickness(const DistanceField& field, const glm::dvec3& from, const glm::dvec3& to,
                                      double tolerance);
/// Thickness as ThicknessTracer::trace() returns it, for the solid alone under a directional light. Sphere tracing
/// finds both the visible points and the thickness. `light_direction` points away from the light. `bounds` encloses
/// the solid.
PELLUCID_API Image march_thickness(const DistanceField& field, const Bounds& bounds, const Camera& camera,
                                   std::uint32_t width, std::uint32_t height, const glm::dvec3& light_direction,
                                   std::uint32_t threads = 0);

}  // namespace pellucid
