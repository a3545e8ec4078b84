#pragma once

#include "gpu/structs.h"

#include <pellucid/scene.h>

#include <span>

namespace pellucid {

/// Fills the camera part of `constants`. `jitter` moves the sample within the pixel, in pixels from
/// its centre (-0.5..0.5). `refractive_corners` are world points whose hull holds all glass.
void set_camera(gpu::FrameConstants& constants, const Camera& camera, std::uint32_t width, std::uint32_t height,
                glm::vec2 jitter, const Bounds& bounds, std::span<const glm::vec3> refractive_corners);

/// Offset of sample `index` within the pixel: the R2 low-discrepancy sequence (Roberts 2018), -0.5..0.5.
glm::vec2 sample_jitter(std::uint32_t index);

}  // namespace pellucid
