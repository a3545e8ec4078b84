#include "light/light_views.h"

#include "core/math.h"
#include "gpu/camera_constants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace pellucid {
namespace {

constexpr float kWidestTan = 1.7320508f;  // tangent of half the widest angle of a view, 60 degrees
constexpr float kMargin = 1.5f;           // texels around the targets, because points are between texels
constexpr float kNearest = 1e-5f;         // near plane, relative to the scene's radius

/// The frame of a camera at `position` that looks along `forward`.
glm::mat4 looking(const glm::vec3& position, const glm::vec3& forward) {
    const glm::vec3 size = glm::abs(forward);
    const glm::vec3 up = size.y <= std::min(size.x, size.z) ? glm::vec3(0, 1, 0)
                         : size.x <= size.z                 ? glm::vec3(1, 0, 0)
                                                            : glm::vec3(0, 0, 1);
    const glm::vec3 z = -glm::normalize(forward), x = glm::normalize(glm::cross(up, z)), y = glm::cross(z, x);
    return {glm::vec4(x, 0.0f), glm::vec4(y, 0.0f), glm::vec4(z, 0.0f), glm::vec4(position, 1.0f)};
}

/// The window of the view plane that the corners cover, in metres or at depth 1. Returns nullopt if a corner is behind
/// the light or too far from the axis.
std::optional<FilmWindow> window_around(std::span<const glm::vec3> corners, const glm::mat4& view_from_world,
                                        bool orthographic) {
    FilmWindow window{glm::vec2(std::numeric_limits<float>::max()), glm::vec2(std::numeric_limits<float>::lowest())};
    for (const glm::vec3& corner : corners) {
        const glm::vec3 p = view_from_world * glm::vec4(corner, 1.0f);
        if (!orthographic && !(std::max(std::abs(p.x), std::abs(p.y)) < -p.z * kWidestTan)) return std::nullopt;
        const glm::vec2 at = orthographic ? glm::vec2(p) : glm::vec2(p) / -p.z;
        window.low = glm::min(window.low, at);
        window.high = glm::max(window.high, at);
    }
    return window;
}

FilmWindow with_margin(FilmWindow window, std::uint32_t resolution, float smallest) {
    const glm::vec2 size = glm::max(window.high - window.low, glm::vec2(smallest));
    const glm::vec2 middle = 0.5f * (window.low + window.high);
    const glm::vec2 half = 0.5f * size * (float(resolution) / std::max(float(resolution) - 2.0f * kMargin, 1.0f));
    return {middle - half, middle + half};
}

LightView view_of(std::uint32_t number, std::uint32_t face, std::uint32_t resolution, const ViewVolume& volume) {
    LightView view{{}, number, face};
    set_view(view.constants, volume, resolution, resolution);
    return view;
}

LightView directional_view(const Light& light, std::uint32_t number, std::span<const glm::vec3> targets,
                           const Bounds& bounds, std::uint32_t resolution) {
    const float radius = std::max(bounds.radius, std::numeric_limits<float>::min());
    const glm::mat4 world_from_view =
        looking(bounds.center - 1.01f * radius * glm::normalize(light.direction), light.direction);
    const FilmWindow window = *window_around(targets, glm::affineInverse(world_from_view), true);
    return view_of(number, LightView::kWhole, resolution,
                   {world_from_view, true, with_margin(window, resolution, 1e-5f * radius), 0.0f, 2.02f * radius});
}

/// True if all corners lie beyond the same side of the face, or behind the light.
bool misses_face(std::span<const glm::vec3> corners, const glm::mat4& view_from_world) {
    std::array<bool, 5> beyond{true, true, true, true, true};
    for (const glm::vec3& corner : corners) {
        const glm::vec3 p = view_from_world * glm::vec4(corner, 1.0f);
        beyond[0] = beyond[0] && p.z >= 0.0f;
        beyond[1] = beyond[1] && p.x > -p.z;
        beyond[2] = beyond[2] && p.x < p.z;
        beyond[3] = beyond[3] && p.y > -p.z;
        beyond[4] = beyond[4] && p.y < p.z;
    }
    return std::any_of(beyond.begin(), beyond.end(), [](bool all) { return all; });
}

std::vector<LightView> cube_views(const Light& light, std::uint32_t number, std::span<const glm::vec3> targets,
                                  const Bounds& bounds, std::uint32_t resolution, float far_plane) {
    constexpr std::array<glm::vec3, 6> kFaces = {glm::vec3(1, 0, 0),  glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0),
                                                 glm::vec3(0, -1, 0), glm::vec3(0, 0, 1),  glm::vec3(0, 0, -1)};
    std::vector<LightView> views;
    for (std::uint32_t face = 0; face < kFaces.size(); ++face) {
        const glm::mat4 world_from_view = looking(light.position, kFaces[face]);
        if (misses_face(targets, glm::affineInverse(world_from_view))) continue;
        const FilmWindow whole{glm::vec2(-1.0f), glm::vec2(1.0f)};
        views.push_back(view_of(
            number, face, resolution,
            {world_from_view, false, with_margin(whole, resolution, 0.0f), kNearest * bounds.radius, far_plane}));
    }
    return views;
}

}  // namespace

std::vector<LightView> light_views(const Light& light, std::uint32_t number, std::span<const glm::vec3> targets,
                                   const Bounds& bounds, std::uint32_t resolution) {
    if (targets.empty()) return {};
    if (light.kind == Light::Kind::kDirectional) return {directional_view(light, number, targets, bounds, resolution)};
    const float radius = std::max(bounds.radius, std::numeric_limits<float>::min());
    const float distance = glm::distance(light.position, bounds.center), far_plane = distance + 1.01f * radius;
    glm::vec3 middle(0.0f);
    for (const glm::vec3& corner : targets) middle += corner / float(targets.size());
    if (glm::distance(middle, light.position) > kNearest * radius) {
        const glm::mat4 world_from_view = looking(light.position, middle - light.position);
        if (const auto window = window_around(targets, glm::affineInverse(world_from_view), false)) {
            // The depth of a point is at least its distance times the cosine of the widest angle, along a diagonal.
            const float near_plane = std::max(0.37f * (distance - 1.01f * radius), kNearest * radius);
            return {view_of(number, LightView::kWhole, resolution,
                            {world_from_view, false, with_margin(*window, resolution, 1e-5f * radius / far_plane),
                             near_plane, far_plane})};
        }
    }
    return cube_views(light, number, targets, bounds, resolution, far_plane);
}

}  // namespace pellucid
