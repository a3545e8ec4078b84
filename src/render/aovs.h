#pragma once

#include "render/frame.h"

#include <pellucid/renderer.h>

#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// Throws Error listing the known names if one of `names` is none.
void check_aov_names(const std::vector<std::string>& names);

/// Whether it is one of kLightParts.
bool is_light_part(const std::string& name);

/// Reads back from a finished frame what `settings` ask for: the AOVs and paths, and the counts of `result`.
/// `view` is what the frame was drawn with, `first_triangles` GpuScene::first_triangles.
void read_back(const Device& device, const FrameImages& images, const gpu::FrameConstants& view,
               const std::vector<std::uint32_t>& first_triangles, const RenderSettings& settings, RenderResult& result);

}  // namespace pellucid
