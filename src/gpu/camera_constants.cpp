#include "gpu/camera_constants.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

struct Range {
    float low, high;
};

/// Depths that cover the scene, kept in front of the camera.
Range clip_range(const Camera& camera, const Bounds& bounds) {
    const float radius = std::max(bounds.radius, 1e-6f);
    const glm::mat4 view_from_world = glm::affineInverse(camera.world_from_view);
    const float center = -(view_from_world * glm::vec4(bounds.center, 1.0f)).z;
    Range range{center - 1.01f * radius, center + 1.01f * radius};
    range.low = std::max(range.low, camera.orthographic ? 0.0f : 1e-5f * radius);
    range.high = std::max(range.high, range.low + radius);
    if (camera.near_plane > 0.0f) range.low = camera.near_plane;
    if (camera.far_plane > 0.0f) range.high = camera.far_plane;
    if (!(range.low < range.high)) range.high = range.low + radius;  // a near plane beyond the scene
    return range;
}

Range glass_range(const glm::mat4& view_from_world, std::span<const glm::vec3> corners, Range clip) {
    Range range{clip.high, clip.low};
    for (const glm::vec3& corner : corners) {
        const float depth = -(view_from_world * glm::vec4(corner, 1.0f)).z;
        range.low = std::min(range.low, depth);
        range.high = std::max(range.high, depth);
    }
    range.low = std::max(range.low, clip.low);
    range.high = std::min(range.high, clip.high);
    return range.low < range.high ? range : clip;
}

/// Clip space from view space for Vulkan: x right, y down, depth 0 (near) to 1 (far).
glm::mat4 clip_matrix(const gpu::FrameConstants& c) {
    const glm::dvec2 corner(double(c.film.x) + double(c.first_x) * double(c.film.z),
                            double(c.film.y) - double(c.first_y) * double(c.film.w));
    const float scale_x = 2.0f / (float(c.width) * c.film.z);
    const float scale_y = 2.0f / (float(c.height) * c.film.w);
    const float offset_x = -float(corner.x) * scale_x - 1.0f;
    const float offset_y = float(corner.y) * scale_y - 1.0f;
    const float range = c.far_plane - c.near_plane;
    glm::mat4 clip(0.0f);
    clip[0][0] = scale_x;
    clip[1][1] = -scale_y;
    if (c.orthographic != 0) {
        clip[3] = glm::vec4(offset_x, offset_y, -c.near_plane / range, 1.0f);
        clip[2][2] = -1.0f / range;
    } else {
        clip[2] = glm::vec4(-offset_x, -offset_y, -c.far_plane / range, -1.0f);
        clip[3][2] = -c.far_plane * c.near_plane / range;
    }
    return clip;
}

}  // namespace

void set_camera(gpu::FrameConstants& constants, const Camera& camera, std::uint32_t width, std::uint32_t height,
                glm::vec2 jitter, const Bounds& bounds, std::span<const glm::vec3> refractive_corners) {
    constants.world_from_view = camera.world_from_view;
    constants.view_from_world = glm::affineInverse(camera.world_from_view);
    constants.width = width;
    constants.height = height;
    constants.first_x = constants.first_y = 0;
    constants.orthographic = camera.orthographic ? 1 : 0;

    const float extent = camera.orthographic ? camera.vertical_extent : 2.0f * std::tan(0.5f * camera.vertical_fov);
    const float pixel = extent / float(height);
    constants.film =
        glm::vec4((-0.5f * float(width) + jitter.x) * pixel, (0.5f * float(height) - jitter.y) * pixel, pixel, pixel);

    const Range clip = clip_range(camera, bounds);
    constants.near_plane = clip.low;
    constants.far_plane = clip.high;
    const Range glass = glass_range(constants.view_from_world, refractive_corners, clip);
    constants.glass_near = glass.low;
    constants.glass_far = glass.high;
    constants.depth_scale = std::exp2(-std::ceil(std::log2(std::max(std::abs(clip.high), std::abs(clip.low)))) - 1.0f);
    constants.clip_from_view = clip_matrix(constants);
}

void set_tile(gpu::FrameConstants& constants, glm::uvec2 first, vk::Extent2D extent) {
    constants.first_x = first.x;
    constants.first_y = first.y;
    constants.width = extent.width;
    constants.height = extent.height;
    constants.clip_from_view = clip_matrix(constants);
}

void set_view(gpu::FrameConstants& constants, const ViewVolume& view, std::uint32_t width, std::uint32_t height) {
    constants.world_from_view = view.world_from_view;
    constants.view_from_world = glm::affineInverse(view.world_from_view);
    constants.width = width;
    constants.height = height;
    constants.first_x = constants.first_y = 0;
    constants.orthographic = view.orthographic ? 1 : 0;
    const glm::vec2 size = view.window.high - view.window.low;
    constants.film = glm::vec4(view.window.low.x, view.window.high.y, size.x / float(width), size.y / float(height));
    constants.near_plane = constants.glass_near = view.near_plane;
    constants.far_plane = constants.glass_far = view.far_plane;
    constants.depth_scale = std::exp2(-std::ceil(std::log2(view.far_plane)) - 1.0f);
    constants.clip_from_view = clip_matrix(constants);
}

void shift_film(gpu::FrameConstants& constants, glm::vec2 texels) {
    constants.film.x += texels.x * constants.film.z;
    constants.film.y -= texels.y * constants.film.w;
    constants.clip_from_view = clip_matrix(constants);
}

glm::vec2 sample_jitter(std::uint32_t index) {
    constexpr double kPlastic = 1.32471795724474602596;
    const double n = double(index) + 1.0;
    return {float(std::fmod(0.5 + n / kPlastic, 1.0) - 0.5),
            float(std::fmod(0.5 + n / (kPlastic * kPlastic), 1.0) - 0.5)};
}

}  // namespace pellucid
