#pragma once

#include "options/named_technique.h"

#include <pellucid/pellucid.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid::cli {

/// A camera around a scene, as in `--camera orbit:AZ,EL,DIST`.
struct OrbitView {
    float azimuth_deg, elevation_deg;
    float distance;  ///< in bounding-sphere radii

    Camera camera(const Bounds& bounds) const;
    std::string description() const;  ///< "orbit:AZ,EL,DIST"
};
/// View `index` of `count`: azimuth 360 index / count degrees, elevation 15, field of view 30 degrees. The distance is
/// equal for all views. It is chosen for a sphere whose diameter is the largest side of the object's box: the sphere
/// fills 70% of the image's height, or of its width if that is less.
OrbitView comparison_view(const Bounds& bounds, int index, int count, std::uint32_t width, std::uint32_t height);

/// The exact paths of a view, and their reliability.
struct ExactView {
    std::uint32_t width = 0, height = 0;
    PixelFootprint footprint;
    std::vector<RefractedPath> paths;   ///< one per pixel
    std::vector<std::uint8_t> covered;  ///< 1 if the first surface is refracting glass
    /// 1 if the exact direction changes by less than 1 degree for view rays shifted by 0.1 px left, right, up and
    /// down.
    std::vector<std::uint8_t> stable;
    /// within_1deg of the exact paths against themselves, with the view ray shifted by 0.0001 px
    double self_within_1deg = 1.0;
};
ExactView trace_exact_view(const Tracer& tracer, const Camera& camera, std::uint32_t width, std::uint32_t height,
                           std::uint32_t max_events, const Progress& progress);

/// A technique's paths compared with the exact ones.
struct Judgement {
    PathAccuracy accuracy;
    Image error_deg;  ///< see path_error_image()
};
Judgement judge(const ExactView& exact, const std::vector<RefractedPath>& paths);

/// Adds the error to a run: shares of pixels (null for no pixels), statuses, groups by exact events.
void add_accuracy(nlohmann::ordered_json& run, const ExactView& exact, const PathAccuracy& accuracy);

}  // namespace pellucid::cli
