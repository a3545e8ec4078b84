#pragma once

#include "gpu/structs.h"
#include "gpu/vulkan.h"

#include <pellucid/scene.h>

#include <span>

namespace pellucid {

/// Fills the camera part of `constants`. `jitter` moves the sample within the pixel, in pixels from
/// its centre (-0.5..0.5). `refractive_corners` are world points whose hull holds all glass.
void set_camera(gpu::FrameConstants& constants, const Camera& camera, std::uint32_t width, std::uint32_t height,
                glm::vec2 jitter, const Bounds& bounds, std::span<const glm::vec3> refractive_corners);

/// After set_camera() of the whole picture: the part of it that is drawn, whose corner is pixel `first`.
void set_tile(gpu::FrameConstants& constants, glm::uvec2 first, vk::Extent2D extent);

/// A part of the plane of view: in metres for an orthographic view, at depth 1 for a perspective one.
struct FilmWindow {
    glm::vec2 low, high;
};
/// A view that need not be straight ahead.
struct ViewVolume {
    glm::mat4 world_from_view;  ///< rigid
    bool orthographic;
    FilmWindow window;
    float near_plane, far_plane;  ///< m, 0 <= near < far; 0 < near for a perspective view
};
/// Fills the camera part of `constants` for a picture of such a view.
void set_view(gpu::FrameConstants& constants, const ViewVolume& view, std::uint32_t width, std::uint32_t height);

/// Moves the view plane's points by `texels` (right and down).
void shift_film(gpu::FrameConstants& constants, glm::vec2 texels);

/// Offset of sample `index` within the pixel: the R2 low-discrepancy sequence (Roberts 2018), -0.5..0.5.
glm::vec2 sample_jitter(std::uint32_t index);

}  // namespace pellucid
