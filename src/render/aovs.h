#pragma once

#include "render/frame.h"

#include <pellucid/renderer.h>

#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// Throws Error listing the known names if one of `names` is unknown.
void check_aov_names(const std::vector<std::string>& names);

/// True for names in kLightParts.
bool is_light_part(const std::string& name);

/// Reads back the AOVs and paths requested by `settings`, and the counts of `result`, from a finished frame. `view`:
/// constants of the frame; `first_triangles`: GpuScene::first_triangles.
void read_back(const Device& device, const FrameImages& images, const gpu::FrameConstants& view,
               const std::vector<std::uint32_t>& first_triangles, const RenderSettings& settings, RenderResult& result);

}  // namespace pellucid
