#pragma once

#include <pellucid/image.h>
#include <pellucid/progress.h>
#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// How the length of solid between a light and a visible point of a translucent surface is found.
enum class ThicknessMethod {
    kTranslucentShadowMap,  ///< from the first surface that the light meets; gaps count as solid
    kLocalThickness,        ///< baked per vertex, whatever the light's direction
    kDepthPeeling,          ///< layers from the light, one geometry pass each
    kDualDepthPeeling,      ///< layers from the light, two per geometry pass
    kLayers,                ///< layers from the light, all in one geometry pass (default)
};

struct ThicknessMethodInfo {
    ThicknessMethod method;
    std::string_view name;     ///< as commands call it
    std::string_view summary;  ///< one line
    std::string_view source;
};
std::span<const ThicknessMethodInfo> thickness_methods();
/// Throws Error listing the known names.
ThicknessMethod parse_thickness_method(std::string_view name);

struct ThicknessSettings {
    ThicknessMethod method = ThicknessMethod::kLayers;
    /// Surfaces that are kept of every ray of light, nearest to the light first, 1 and more. Solid behind the last
    /// one is not counted; an odd one out is the entry of a solid whose exit is not known, and counts nothing.
    std::uint32_t layers = 8;
    std::uint32_t resolution = 1024;  ///< texels along a side of a light's map, from 2
};

/// What is measured for one light.
struct ThicknessRequest {
    std::uint32_t width = 512;  ///< pixels
    std::uint32_t height = 512;
    ThicknessSettings settings;
    std::uint32_t light = 0;  ///< Scene::lights
    bool time_maps = false;   ///< build the light's maps once more, alone, for ThicknessResult::map_ms
    Progress progress;        ///< of baking
};

/// Thickness of a pixel where there is none.
inline constexpr float kNotTranslucent = -1.0f;  ///< something else is seen, or the light's cone or range ends before
inline constexpr float kShadowed = -2.0f;        ///< an opaque object is in between

struct ThicknessResult {
    /// One channel: m of solid between the light and the visible point, or one of the constants above.
    Image thickness;
    std::uint64_t cut_rays = 0;         ///< visible points whose ray of light crosses more surfaces than were kept
    std::uint32_t geometry_passes = 0;  ///< that built the light's layers
    std::uint32_t light_views = 0;      ///< maps that the light needed: 1, or faces of a cube around a point light
    double wall_ms = 0.0;               ///< from recording to the finished image, host and device
    double map_ms = 0.0;                ///< of building the light's maps alone, if asked for
    std::vector<std::string> warnings;
};

/// The exact thickness: a ray of Embree from every visible point to the light, in double precision. Solids are told
/// from gaps by the sides of their triangles: a ray is in a solid as long as it has entered more than it has left;
/// an entry without an exit counts nothing.
class ThicknessTracer {
public:
    /// Builds the hierarchy. `scene` must be checked (load_scene does it) and outlive the tracer. `threads` 0: all
    /// cores.
    explicit ThicknessTracer(const Scene& scene, std::uint32_t threads = 0);
    ~ThicknessTracer();
    ThicknessTracer(ThicknessTracer&&) noexcept;
    ThicknessTracer& operator=(ThicknessTracer&&) noexcept;

    /// As ThicknessResult::thickness. Throws Error if there is no such light.
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
DistanceField distance_to(std::vector<Ball> balls);
/// Length of the segment from `from` to `to` that lies in the solid, by sphere tracing (Hart 1996, "Sphere Tracing")
/// in and out of it. `tolerance`: m within which the surface counts as reached.
double marched_thickness(const DistanceField& field, const glm::dvec3& from, const glm::dvec3& to, double tolerance);
/// As ThicknessTracer::trace, of the solid alone, for a directional light that goes along `light_direction`. Visible
/// points and thickness are both marched. `bounds` holds the solid.
Image march_thickness(const DistanceField& field, const Bounds& bounds, const Camera& camera, std::uint32_t width,
                      std::uint32_t height, const glm::dvec3& light_direction, std::uint32_t threads = 0);

/// How far a thickness is off, over the pixels at which either image has one; a pixel without counts as 0.
struct ThicknessError {
    std::uint64_t points = 0;         ///< at which both have one
    std::uint64_t unmatched = 0;      ///< at which one has, mostly the picture's silhouettes
    double relative = 0.0;            ///< sum |d - d*| / sum d* (Chen); 0 if both are 0
    double mean = 0.0;                ///< mean |d - d*|, m
    double p95 = 0.0, largest = 0.0;  ///< of |d - d*|, m
};
/// Throws Error for sizes that do not match. `difference`, if given, becomes |d - d*| per pixel, m.
ThicknessError thickness_error(const Image& truth, const Image& thickness, Image* difference = nullptr);

}  // namespace pellucid
