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

/// Method of finding the length of solid between a light and a visible point of a translucent surface.
enum class ThicknessMethod {
    kTranslucentShadowMap,  ///< distance from the first surface seen by the light; gaps count as solid
    kLocalThickness,        ///< baked per vertex, independent of the light's direction
    kDepthPeeling,          ///< layers from the light, one geometry pass each
    kDualDepthPeeling,      ///< layers from the light, two per geometry pass
    kLayers,                ///< layers from the light, all in one geometry pass (default)
    // Published forms, for comparison.
    kPublishedShadowMap,       ///< depth of the point minus the depth that the nearest texel stores
    kPublishedLocalThickness,  ///< share of the samples around a vertex that lie inside
    kPublishedDepthPeeling,    ///< depths that the nearest texel stores, compared with the point's depth
};

struct ThicknessMethodInfo {
    ThicknessMethod method;
    std::string_view name;     ///< name in commands
    std::string_view summary;  ///< one line
    std::string_view source;
};
PELLUCID_API std::span<const ThicknessMethodInfo> thickness_methods();
/// Throws Error listing the known names.
PELLUCID_API ThicknessMethod parse_thickness_method(std::string_view name);

struct ThicknessSettings {
    ThicknessMethod method = ThicknessMethod::kLayers;
    /// Surfaces kept of every light ray, nearest to the light first, >= 1. Solid behind the last surface is not
    /// counted. An unpaired entry has an unknown exit and contributes no thickness.
    std::uint32_t layers = 8;
    std::uint32_t resolution = 1024;  ///< texels along a side of a light's map, >= 2

    bool operator==(const ThicknessSettings&) const = default;
};

/// Settings of a measurement for one light.
struct ThicknessRequest {
    std::uint32_t width = 512;  ///< pixels
    std::uint32_t height = 512;
    ThicknessSettings settings;
    std::uint32_t light = 0;  ///< index into Scene::lights
    bool time_maps = false;   ///< build the light's maps a second time, alone, for ThicknessResult::map_ms
    Progress progress;        ///< progress of baking
};

struct ThicknessResult {
    /// One channel: thickness of solid between the light and the visible point in m, kNotTranslucent or kShadowed.
    Image thickness;
    std::uint64_t cut_rays = 0;         ///< visible points whose light ray crosses more surfaces than were kept
    std::uint32_t geometry_passes = 0;  ///< geometry passes that built the light's layers
    std::uint32_t light_views = 0;      ///< maps of the light: 1, or the faces of a cube around a point light
    double wall_ms = 0.0;               ///< from recording to the finished image, host and device
    double map_ms = 0.0;                ///< time to build the light's maps alone, if requested
    std::vector<std::string> warnings;
};

}  // namespace pellucid
