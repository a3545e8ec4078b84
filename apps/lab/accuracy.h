#pragma once

#include "options/named_technique.h"

#include <pellucid/pellucid.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid::cli {

/// A camera around a scene, as `--camera orbit:AZ,EL,DIST` gives it.
struct OrbitView {
    float azimuth_deg, elevation_deg;
    float distance;  ///< in bounding-sphere radii

    Camera camera(const Bounds& bounds) const;
    std::string description() const;  ///< "orbit:AZ,EL,DIST"
};
/// View `index` of `count`: azimuth 360 index / count degrees, elevation 15, 30 degree field of view. The
/// distance is the same for all: the largest side of the object's box, taken for the diameter of a
/// sphere, fills 70% of the picture's height (or of its width where that is less).
OrbitView comparison_view(const Bounds& bounds, int index, int count, std::uint32_t width, std::uint32_t height);

/// The exact paths of a view, and how far they can be trusted.
struct ExactView {
    std::uint32_t width = 0, height = 0;
    PixelFootprint footprint;
    std::vector<RefractedPath> paths;   ///< one per pixel
    std::vector<std::uint8_t> covered;  ///< 1 where the first surface is refracting glass
    /// 1 where the exact direction moves less than 1 degree when the view ray is shifted by 0.1 px left,
    /// right, up and down.
    std::vector<std::uint8_t> stable;
    double self_within_1deg = 1.0;  ///< exact against itself, the view ray shifted by 0.0001 px
};
ExactView trace_exact_view(const Tracer& tracer, const Camera& camera, std::uint32_t width, std::uint32_t height,
                           std::uint32_t max_events, const Progress& progress);

/// A technique's paths held against the exact ones.
struct Judgement {
    PathAccuracy accuracy;
    Image error_deg;  ///< see path_error_image()
};
Judgement judge(const ExactView& exact, const std::vector<RefractedPath>& paths);

/// Adds the error to a run: shares of pixels (null of none), statuses, groups by exact events.
void add_accuracy(nlohmann::ordered_json& run, const ExactView& exact, const PathAccuracy& accuracy);

}  // namespace pellucid::cli
