#pragma once

#include "render/frame.h"

#include <string>
#include <vector>

namespace pellucid {

/// Throws Error listing the known names if one of `names` is none.
void check_aov_names(const std::vector<std::string>& names);

/// Reads the named AOVs, and the counts of `result`, back from a finished frame.
/// `first_triangles`: GpuScene::first_triangles.
void read_aovs(const Device& device, const FrameImages& images, const std::vector<std::uint32_t>& first_triangles,
               const std::vector<std::string>& names, RenderResult& result);

}  // namespace pellucid
