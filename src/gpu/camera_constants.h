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

/// Restricts set_camera() of the whole image to a tile of size `extent` at pixel `first`.
void set_tile(gpu::FrameConstants& constants, glm::uvec2 first, vk::Extent2D extent);

/// A rectangle of the view plane: in metres for an orthographic view, at depth 1 for a perspective view.
struct FilmWindow {
    glm::vec2 low, high;
};
/// A view whose window may be off the axis.
struct ViewVolume {
    glm::mat4 world_from_view;  ///< rigid
    bool orthographic;
    FilmWindow window;
    float near_plane, far_plane;  ///< m, 0 <= near < far; 0 < near for a perspective view
};
/// Fills the camera part of `constants` for an image of `view`.
void set_view(gpu::FrameConstants& constants, const ViewVolume& view, std::uint32_t width, std::uint32_t height);

/// Shifts the view plane by `texels` (right and down).
void shift_film(gpu::FrameConstants& constants, glm::vec2 texels);

/// Offset of sample `index` within the pixel: the R2 low-discrepancy sequence (Roberts 2018), -0.5..0.5.
glm::vec2 sample_jitter(std::uint32_t index);

}  // namespace pellucid
