#pragma once

#include "render/frame.h"

#include <pellucid/renderer.h>

#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// The AOV of a name. `depth-3` is `depth` of the third surface; other names are those of aov_infos().
struct NamedAov {
    const AovInfo* info;
    std::uint32_t layer = 0;  ///< of depth, normal and object
};
/// Throws Error listing the known names if `name` is unknown.
NamedAov parse_aov(const std::string& name);

/// Throws Error if one of `names` is of a surface beyond the technique's `layers`.
void check_aov_layers(const std::vector<std::string>& names, std::uint32_t layers, std::string_view technique);

/// True for names in kLightParts.
bool is_light_part(const std::string& name);

/// Reads back the AOVs and paths requested by `settings`, and the counts of `result`, from a finished frame. `view`:
/// constants of the frame; `first_triangles`: GpuScene::first_triangles.
void read_back(const Device& device, const FrameImages& images, const gpu::FrameConstants& view,
               const std::vector<std::uint32_t>& first_triangles, const RenderSettings& settings, RenderResult& result);

}  // namespace pellucid
