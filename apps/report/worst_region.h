#pragma once

#include <pellucid/image.h>

#include <optional>

namespace pellucid {

/// A square of pixels, and the mean of a map over it.
struct Region {
    int x = 0;  ///< pixels from the left and top of the image to the region
    int y = 0;
    int size = 0;  ///< pixels along each side
    double mean = 0.0;
};

/// Side of the candidate regions in an image, pixels: small enough to magnify, large enough to recognise.
int region_size(int width, int height);

/// The square of region_size() with the greatest mean of `map` (one channel). Negative values and NaN (not covered)
/// count as 0, so many wrong pixels outweigh a few at a silhouette. Empty if the map is nowhere above 0. Ties choose
/// the first, by rows from the top.
std::optional<Region> worst_region(const Image& map);

}  // namespace pellucid
