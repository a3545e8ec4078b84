#pragma once

#include "gpu/gpu_scene.h"
#include "gpu/workspace.h"

namespace pellucid {

/// What every pass of a frame may look at.
struct Frame {
    Workspace& workspace;
    const GpuScene& scene;
    const Buffer& constants;      ///< one gpu::FrameConstants, bound as "Frame"
    const GpuImage& environment;  ///< map, or one texel if the environment is a formula
    vk::Extent2D extent;
};

}  // namespace pellucid
