#pragma once

#include <pellucid/image.h>

#include <optional>

namespace pellucid {

/// A square of pixels, and the mean of a map over it.
struct Region {
    int x = 0;  ///< pixels from the left and the top of the image to those of the region
    int y = 0;
    int size = 0;  ///< pixels, both ways
    double mean = 0.0;
};

/// Side of the regions that are looked at in an image: small enough to be magnified, large enough to be recognised.
int region_size(int width, int height);

/// The square of region_size() with the greatest mean of `map` (one channel), where negative values and NaN (not
/// covered) count as 0: many wrong pixels outweigh a few at a silhouette. None if the map is nowhere above 0. Of
/// equal ones the first, by rows from the top.
std::optional<Region> worst_region(const Image& map);

}  // namespace pellucid
