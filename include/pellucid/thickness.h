#pragma once

#include <pellucid/api.h>
#include <pellucid/exact_thickness.h>
#include <pellucid/image.h>
#include <pellucid/measure.h>
#include <pellucid/progress.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// How the length of solid between a light and a visible point of a translucent surface is found.
enum class ThicknessMethod {
    kTranslucentShadowMap,  ///< from the first surface that the light meets; gaps count as solid
    kLocalThickness,        ///< baked per vertex, whatever the light's direction
    kDepthPeeling,          ///< layers from the light, one geometry pass each
    kDualDepthPeeling,      ///< layers from the light, two per geometry pass
    kLayers,                ///< layers from the light, all in one geometry pass (default)
};

struct ThicknessMethodInfo {
    ThicknessMethod method;
    std::string_view name;     ///< as commands call it
    std::string_view summary;  ///< one line
    std::string_view source;
};
PELLUCID_API std::span<const ThicknessMethodInfo> thickness_methods();
/// Throws Error listing the known names.
PELLUCID_API ThicknessMethod parse_thickness_method(std::string_view name);

struct ThicknessSettings {
    ThicknessMethod method = ThicknessMethod::kLayers;
    /// Surfaces that are kept of every ray of light, nearest to the light first, 1 and more. Solid behind the last
    /// one is not counted; an odd one out is the entry of a solid whose exit is not known, and counts nothing.
    std::uint32_t layers = 8;
    std::uint32_t resolution = 1024;  ///< texels along a side of a light's map, from 2

    bool operator==(const ThicknessSettings&) const = default;
};

/// What is measured for one light.
struct ThicknessRequest {
    std::uint32_t width = 512;  ///< pixels
    std::uint32_t height = 512;
    ThicknessSettings settings;
    std::uint32_t light = 0;  ///< Scene::lights
    bool time_maps = false;   ///< build the light's maps once more, alone, for ThicknessResult::map_ms
    Progress progress;        ///< of baking
};

struct ThicknessResult {
    /// One channel: m of solid between the light and the visible point, kNotTranslucent or kShadowed.
    Image thickness;
    std::uint64_t cut_rays = 0;         ///< visible points whose ray of light crosses more surfaces than were kept
    std::uint32_t geometry_passes = 0;  ///< that built the light's layers
    std::uint32_t light_views = 0;      ///< maps that the light needed: 1, or faces of a cube around a point light
    double wall_ms = 0.0;               ///< from recording to the finished image, host and device
    double map_ms = 0.0;                ///< of building the light's maps alone, if asked for
    std::vector<std::string> warnings;
};

}  // namespace pellucid
