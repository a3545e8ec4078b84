#pragma once

#include <cstddef>
#include <vector>

namespace pellucid {

/// One-dimensional filter, weights at -radius() to +radius() pixels.
struct FilterKernel {
    std::vector<float> weights;
    int radius() const { return int(weights.size() / 2); }
};

/// The filters of FLIP for one viewing distance. Each is a sum of separable filters: first along rows, then along
/// columns. A colour filter's weights sum to 1 over the plane. A derivative's negative weights sum to -1, its positive
/// weights to 1.
struct FlipFilters {
    /// Contrast sensitivity of the eye; blue-yellow is a sum of two Gaussians.
    FilterKernel lightness, red_green;
    FilterKernel blue_yellow_row[2], blue_yellow_column[2];
    /// Gaussian and its first two derivatives, which find edges and points.
    FilterKernel smooth, edge, point;

    int radius() const;  ///< largest radius, px
};
FlipFilters flip_filters(double pixels_per_degree);

/// Block size of rows of pixels, so that the sums of a block stay in registers.
inline constexpr std::size_t kFilterBlock = 16;
constexpr std::size_t filter_pitch(std::size_t width) {
    return (width + kFilterBlock - 1) / kFilterBlock * kFilterBlock;
}

/// out[x] = sum over j of weights[j] * in[x + j], for x below `pitch`, a multiple of kFilterBlock.
void filter_row(const FilterKernel& kernel, const float* in, float* out, std::size_t pitch);

/// out[x] += sum over j of weights[j] * rows[j][x], for x below `pitch`, a multiple of kFilterBlock.
void add_filtered_column(const FilterKernel& kernel, const float* const* rows, float* out, std::size_t pitch);

}  // namespace pellucid
