#pragma once

#include <pellucid/api.h>
#include <pellucid/image.h>
#include <pellucid/refracted_path.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

/// Share of the covered pixels in a group, and how many of them are right. NaN-free: an empty group
/// has share 0 and within_1deg 1.
struct GroupAccuracy {
    double share = 0.0;
    double within_1deg = 1.0;
};

/// How far a technique's paths are from the exact ones. Shares are of the covered pixels, those
/// where the exact path meets refracting glass first.
///
/// A pixel is right if the exit directions differ by less than the angle; one that the technique gave up
/// on (status other than ok) or did not cover is wrong. Where the exact path is itself cut after K events
/// (Status::kEventLimit), one that is cut, too, is right if the directions there agree. A path that ends on
/// an opaque object is right if the technique's ends on the same one within a pixel's footprint of the
/// same point.
struct PathAccuracy {
    std::uint64_t covered = 0;
    double within_1deg = 1.0;
    double within_5deg = 1.0;
    double stable_share = 1.0;
    double within_1deg_stable = 1.0;  ///< within_1deg over the stable pixels
    double median_deg = 0.0;          ///< 180 stands for a pixel that is wrong without a direction
    double p95_deg = 0.0;
    std::array<double, kStatusCount> status{};
    GroupAccuracy two_events, four_events, more_events;  ///< by exact events: <= 2, 3 to 4, > 4
    GroupAccuracy with_tir;                              ///< exact paths with total internal reflection
};

/// Size of a pixel's footprint after a path of length s: at_eye + per_metre * s, in metres.
struct PixelFootprint {
    float at_eye = 0.0f;
    float per_metre = 0.0f;
};

/// Error of one path in degrees, 0..180; 180 where `candidate` has no answer. -1 where `exact` is not covered.
/// Where one of them ends on an opaque object it is 0 or 180: right or wrong.
PELLUCID_API float path_error_deg(const RefractedPath& exact, const RefractedPath& candidate,
                                  const PixelFootprint& footprint);

/// Error of every path, as an image of one channel.
PELLUCID_API Image path_error_image(int width, int height, std::span<const RefractedPath> exact,
                                    std::span<const RefractedPath> candidate, const PixelFootprint& footprint);

/// `error_deg` as path_error_image() gives it; `stable`, one per pixel, is 0 for an unstable one.
PELLUCID_API PathAccuracy path_accuracy(std::span<const RefractedPath> exact, std::span<const RefractedPath> candidate,
                                        const Image& error_deg, std::span<const std::uint8_t> stable);

/// LDR-FLIP (Andersson et al. 2020): the perceived difference between two pictures that are seen in
/// alternation, 0..1 per pixel. Inputs: RGB, 0..1 (clipped, NaN is 0), sRGB-encoded, of equal size; symmetric in them.
/// Throws Error for anything else, and for less than 1 pixel per degree.
PELLUCID_API Image flip_ldr(const Image& reference, const Image& test, double pixels_per_degree = 67.020645);

/// What HDR-FLIP chose or was given. Exposures in stops.
struct FlipExposures {
    double start = 0.0;
    double stop = 0.0;
    int count = 2;
};
/// Exposure range that suits `reference` (RGB, linear), after Andersson et al. 2021, section 4.2. Infinite pixels
/// are left out; where black ones are the most, the median of the others stands; 0 to 0 for a black picture.
PELLUCID_API FlipExposures flip_exposures(const Image& reference);

/// HDR-FLIP (Andersson et al. 2021): per pixel the greatest LDR-FLIP over exposures, tone mapped by
/// the fitted ACES curve. Inputs: RGB, scene-linear, of equal size; what is negative or NaN is 0.
PELLUCID_API Image flip_hdr(const Image& reference, const Image& test, const FlipExposures& exposures,
                            double pixels_per_degree = 67.020645);

/// Mean of a one-channel image over the pixels whose mask is not 0; over all for an empty mask; 0 over none.
PELLUCID_API double mean(const Image& image, std::span<const std::uint8_t> mask = {});

/// Root of the mean squared difference over the masked pixels and all channels. Both throw Error for sizes that
/// do not match; NaN stays NaN.
PELLUCID_API double rmse(const Image& reference, const Image& test, std::span<const std::uint8_t> mask = {});

/// Median and 95th percentile (nearest rank). Throws Error for no values; NaN counts as infinite.
struct Spread {
    double median = 0.0;
    double p95 = 0.0;
};
PELLUCID_API Spread spread(std::vector<double> values);

/// How far a thickness is off, over the pixels at which either image has one; a pixel without counts as 0.
struct ThicknessError {
    std::uint64_t points = 0;         ///< at which both have one
    std::uint64_t unmatched = 0;      ///< at which one has, mostly the picture's silhouettes
    double relative = 0.0;            ///< sum |d - d*| / sum d* (Chen); 0 if both are 0
    double mean = 0.0;                ///< mean |d - d*|, m
    double p95 = 0.0, largest = 0.0;  ///< of |d - d*|, m
};
/// Throws Error for sizes that do not match. `difference`, if given, becomes |d - d*| per pixel, m.
PELLUCID_API ThicknessError thickness_error(const Image& truth, const Image& thickness, Image* difference = nullptr);

}  // namespace pellucid
