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

/// Thickness of a pixel where there is none.
inline constexpr float kNotTranslucent = -1.0f;  ///< something else is seen, or the light's cone or range ends before
inline constexpr float kShadowed = -2.0f;        ///< an opaque object is in between

/// The exact thickness: a ray of Embree from every visible point to the light, in double precision. Solids are told
/// from gaps by the sides of their triangles: a ray is in a solid as long as it has entered more than it has left;
/// an entry without an exit counts nothing.
class PELLUCID_API ThicknessTracer {
public:
    /// Builds the hierarchy. `scene` must be checked (load_scene does it) and outlive the tracer. `threads` 0: all
    /// cores.
    explicit ThicknessTracer(const Scene& scene, std::uint32_t threads = 0);
    ~ThicknessTracer();
    ThicknessTracer(ThicknessTracer&&) noexcept;
    ThicknessTracer& operator=(ThicknessTracer&&) noexcept;

    /// One channel: m of solid between the light and the visible point, kNotTranslucent or kShadowed. Throws Error if there is no such light.
    Image trace(const Camera& camera, std::uint32_t width, std::uint32_t height, std::uint32_t light,
                const Progress& progress = {}) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Signed distance to a solid, m, negative inside: no more than the true distance anywhere.
using DistanceField = std::function<double(const glm::dvec3&)>;
/// The union of balls.
struct Ball {
    glm::dvec3 center{0.0};
    double radius = 1.0;
};
PELLUCID_API DistanceField distance_to(std::vector<Ball> balls);
/// Length of the segment from `from` to `to` that lies in the solid, by sphere tracing (Hart 1996, "Sphere Tracing")
/// in and out of it. `tolerance`: m within which the surface counts as reached.
PELLUCID_API double marched_thickness(const DistanceField& field, const glm::dvec3& from, const glm::dvec3& to,
                                      double tolerance);
/// As ThicknessTracer::trace, of the solid alone, for a directional light that goes along `light_direction`. Visible
/// points and thickness are both marched. `bounds` holds the solid.
PELLUCID_API Image march_thickness(const DistanceField& field, const Bounds& bounds, const Camera& camera,
                                   std::uint32_t width, std::uint32_t height, const glm::dvec3& light_direction,
                                   std::uint32_t threads = 0);

}  // namespace pellucid
