#pragma once

#include <pellucid/pellucid.h>

#include <span>
#include <string>
#include <string_view>

namespace pellucid::viewer {

/// A map of a quantity over the image, in colours.
struct OverlayInfo {
    std::string_view name;
    std::string_view legend;  ///< what dark and bright mean
};
/// `error`, `status`, `layers`, `thickness`, `caustic`.
std::span<const OverlayInfo> overlay_infos();
/// Throws Error listing the known names.
const OverlayInfo& find_overlay(std::string_view name);

/// Draws an overlay with the renderer, whose frames have all been read. RGB, 0..1, for display. `settings`: of the image; the
/// overlay has one sample, at pixel centres. `scene` and `camera`: the renderer's.
Image draw_overlay(std::string_view name, Renderer& renderer, const Camera& camera, const Bounds& bounds,
                   RenderSettings settings);

}  // namespace pellucid::viewer
