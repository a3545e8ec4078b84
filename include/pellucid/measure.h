#pragma once

#include <pellucid/api.h>
#include <pellucid/image.h>
#include <pellucid/refracted_path.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

/// Accuracy of a group of covered pixels: its share, and the share of right pixels in it. Never NaN: an empty group
/// has share 0 and within_1deg 1.
struct GroupAccuracy {
    double share = 0.0;
    double within_1deg = 1.0;
};

/// Error of a technique's paths against the exact paths. Shares refer to the covered pixels, where the exact path
/// meets refracting glass first.
///
/// A pixel is right if the exit directions differ by less than the angle. It is wrong if the technique abandoned it
/// (status other than ok) or did not cover it. If the exact path is cut after K events (Status::kEventLimit), a path
/// that is cut after equally many events is right if the directions there agree. A path that ends on an opaque object
/// is right if both end on the same object, within a pixel's footprint of the same point.
struct PathAccuracy {
    std::uint64_t covered = 0;
    double within_1deg = 1.0;
    double within_5deg = 1.0;
    double stable_share = 1.0;
    double within_1deg_stable = 1.0;  ///< within_1deg over the stable pixels
    double median_deg = 0.0;          ///< a wrong pixel without a direction counts as 180
    double p95_deg = 0.0;
    std::array<double, kStatusCount> status{};
    GroupAccuracy two_events, four_events, more_events;  ///< groups by exact events: <= 2, 3 to 4, > 4
    GroupAccuracy with_tir;                              ///< exact paths with total internal reflection
};

/// Size of a pixel's footprint after a path of length s: at_eye + per_metre * s, in metres.
struct PixelFootprint {
    float at_eye = 0.0f;
    float per_metre = 0.0f;
};

/// Error of one path in degrees, 0..180; 180 if `candidate` has no result, -1 if `exact` is not covered. If either
/// path ends on an opaque object, the error is 0 (right) or 180 (wrong).
PELLUCID_API float path_error_deg(const RefractedPath& exact, const RefractedPath& candidate,
                                  const PixelFootprint& footprint);

/// Error of every path in degrees, as an image with one channel; see path_error_deg().
PELLUCID_API Image path_error_image(int width, int height, std::span<const RefractedPath> exact,
                                    std::span<const RefractedPath> candidate, const PixelFootprint& footprint);

/// Accuracy over all pixels. `error_deg`: image from path_error_image(). `stable`: one value per pixel, 0 for an
/// unstable one.
PELLUCID_API PathAccuracy path_accuracy(std::span<const RefractedPath> exact, std::span<const RefractedPath> candidate,
                                        const Image& error_deg, std::span<const std::uint8_t> stable);

/// LDR-FLIP (Andersson et al. 2020): the perceived difference between two images seen in alternation, 0..1 per pixel.
/// Inputs: RGB, 0..1 (clipped, NaN is 0), sRGB-encoded, of equal size. Symmetric in its inputs. Throws Error for other
/// inputs, and for less than 1 pixel per degree.
PELLUCID_API Image flip_ldr(const Image& reference, const Image& test, double pixels_per_degree = 67.020645);

/// Exposures of HDR-FLIP, in stops.
struct FlipExposures {
    double start = 0.0;
    double stop = 0.0;
    int count = 2;
};
/// Exposure range for `reference` (RGB, linear), after Andersson et al. 2021, section 4.2. Infinite pixels are
/// ignored. If most pixels are black, the median is that of the other pixels. A black image gives 0 to 0.
PELLUCID_API FlipExposures flip_exposures(const Image& reference);

/// HDR-FLIP (Andersson et al. 2021): the greatest LDR-FLIP of each pixel over all exposures, tone mapped by the fitted
/// ACES curve. Inputs: RGB, scene-linear, of equal size; negative values and NaN count as 0.
PELLUCID_API Image flip_hdr(const Image& reference, const Image& test, const FlipExposures& exposures,
                            double pixels_per_degree = 67.020645);

/// Mean of a one-channel image over the pixels with a non-zero mask. An empty mask selects all pixels; the mean of no
/// pixels is 0. Throws Error if the mask's size differs or the image has several channels.
PELLUCID_API double mean(const Image& image, std::span<const std::uint8_t> mask = {});

/// Root of the mean squared difference over the masked pixels and all channels. NaN stays NaN. Throws Error if sizes
/// differ.
PELLUCID_API double rmse(const Image& reference, const Image& test, std::span<const std::uint8_t> mask = {});

/// Median and 95th percentile (nearest rank). Throws Error for no values; NaN counts as infinite.
struct Spread {
    double median = 0.0;
    double p95 = 0.0;
};
PELLUCID_API Spread spread(std::vector<double> values);

/// Error of a thickness image, over the pixels with a thickness in either image. A pixel without thickness counts as
/// 0.
struct ThicknessError {
    std::uint64_t points = 0;         ///< pixels with a thickness in both images
    std::uint64_t unmatched = 0;      ///< pixels with a thickness in one image, mostly at silhouettes
    double relative = 0.0;            ///< sum |d - d*| / sum d* (Chen); 0 if both are 0, 1 if only sum d* is
    double mean = 0.0;                ///< mean of |d - d*|, m
    double p95 = 0.0, largest = 0.0;  ///< 95th percentile and maximum of |d - d*|, m
};
/// Throws Error if sizes differ. `difference`, if not null, receives |d - d*| per pixel, m.
PELLUCID_API ThicknessError thickness_error(const Image& truth, const Image& thickness, Image* difference = nullptr);

}  // namespace pellucid
