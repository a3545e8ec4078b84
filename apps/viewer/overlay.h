#pragma once

#include <pellucid/pellucid.h>

#include <span>
#include <string>
#include <string_view>

namespace pellucid::viewer {

/// A coloured map of a quantity over the image.
struct OverlayInfo {
    std::string_view name;
    std::string_view legend;  ///< meaning of dark and bright
};
/// The overlays `error`, `status`, `layers`, `thickness`, `caustic`.
std::span<const OverlayInfo> overlay_infos();
/// Throws Error listing the known overlays.
const OverlayInfo& find_overlay(std::string_view name);

/// Draws an overlay with the renderer: RGB, 0..1, for display. All frames of the renderer must have been read.
/// `settings`: of the image; the overlay itself has one sample, at pixel centres. `camera`, `bounds`: of the
/// renderer's scene.
Image draw_overlay(std::string_view name, Renderer& renderer, const Camera& camera, const Bounds& bounds,
                   RenderSettings settings);

}  // namespace pellucid::viewer
