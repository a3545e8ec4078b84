// LDR-FLIP: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild, "FLIP: A Difference Evaluator for
// Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020.
#include "measure/flip_map.h"

#include "measure/flip_color.h"
#include "measure/flip_filters.h"

#include <pellucid/error.h>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace pellucid {
namespace {

// Section 4.1.3: the colour difference is compressed. Its lower part, up to kColorKnee of the largest difference,
// takes kColorKneeValue of the range.
constexpr float kColorExponent = 0.7f;
constexpr float kColorKnee = 0.4f;
constexpr float kColorKneeValue = 0.95f;
constexpr float kFeatureExponent = 0.5f;  // section 4.2.2

/// Rows of floats, each padded to whole blocks of the filters.
class Rows {
public:
    Rows(std::size_t width, std::size_t count) : pitch_(filter_pitch(width)), values_(pitch_ * count) {}
    float* operator[](std::size_t row) { return values_.data() + row * pitch_; }
    const float* operator[](std::size_t row) const { return values_.data() + row * pitch_; }
    std::size_t pitch() const { return pitch_; }

private:
    std::size_t pitch_;
    std::vector<float> values_;
};

/// Consecutive rows of an image.
struct Band {
    int first, count;
};

/// A band filtered along its rows, including the rows above and below that column filters need.
struct RowFiltered {
    Band band;
    Rows lightness, red_green, blue_yellow_a, blue_yellow_b, smooth, edge, point;
};

/// Loads a row of the image in the opponent space as three planes, with its ends repeated over `margin` pixels.
void load_row(const Image& image, int y, const ShownColor& shown, std::size_t margin,
              std::array<std::vector<float>, 3>& planes) {
    const std::size_t width = std::size_t(image.width);
    for (std::size_t x = 0; x < width; ++x) {
        const float* rgb = image.at(int(x), y);
        const glm::vec3 opponent = opponent_from_linear(shown({rgb[0], rgb[1], rgb[2]}));
        for (std::size_t c = 0; c < 3; ++c) planes[c][margin + x] = opponent[int(c)];
    }
    for (std::vector<float>& plane : planes) {
        std::fill_n(plane.begin(), margin, plane[margin]);
        std::fill(plane.begin() + std::ptrdiff_t(margin + width), plane.end(), plane[margin + width - 1]);
    }
}

RowFiltered filter_rows(const Image& image, Band band, const ShownColor& shown, const FlipFilters& filters) {
    const std::size_t margin = std::size_t(filters.radius());
    const Rows blank(std::size_t(image.width), std::size_t(band.count));
    RowFiltered out{band, blank, blank, blank, blank, blank, blank, blank};
    const std::size_t pitch = blank.pitch();
    std::array<std::vector<float>, 3> planes;
    planes.fill(std::vector<float>(pitch + 2 * margin));
    const auto filter = [&](const FilterKernel& kernel, std::size_t plane, float* row) {
        filter_row(kernel, planes[plane].data() + (margin - std::size_t(kernel.radius())), row, pitch);
    };
    for (std::size_t i = 0; i < std::size_t(band.count); ++i) {
        load_row(image, band.first + int(i), shown, margin, planes);
        filter(filters.lightness, 0, out.lightness[i]);
        filter(filters.red_green, 1, out.red_green[i]);
        filter(filters.blue_yellow_row[0], 2, out.blue_yellow_a[i]);
        filter(filters.blue_yellow_row[1], 2, out.blue_yellow_b[i]);
        filter(filters.smooth, 0, out.smooth[i]);
        filter(filters.edge, 0, out.edge[i]);
        filter(filters.point, 0, out.point[i]);
    }
    return out;
}

/// Filtered values of one row.
struct PerceivedRow {
    std::array<std::vector<float>, 3> color;  ///< opponent space
    std::array<std::vector<float>, 4> slope;  ///< edge along x, y; point along x, y
};

/// Filters row y of the image along columns.
void filter_columns(const RowFiltered& in, int y, const FlipFilters& filters, int height, PerceivedRow& out) {
    const std::size_t pitch = in.lightness.pitch();
    std::vector<const float*> column;
    const auto add = [&](const FilterKernel& kernel, const Rows& rows, std::vector<float>& to) {
        column.clear();
        for (int j = y - kernel.radius(); j <= y + kernel.radius(); ++j)
            column.push_back(rows[std::size_t(std::clamp(j, 0, height - 1) - in.band.first)]);
        add_filtered_column(kernel, column.data(), to.data(), pitch);
    };
    for (std::vector<float>& row : out.color) row.assign(pitch, 0.0f);
    for (std::vector<float>& row : out.slope) row.assign(pitch, 0.0f);
    add(filters.lightness, in.lightness, out.color[0]);
    add(filters.red_green, in.red_green, out.color[1]);
    add(filters.blue_yellow_column[0], in.blue_yellow_a, out.color[2]);
    add(filters.blue_yellow_column[1], in.blue_yellow_b, out.color[2]);
    add(filters.smooth, in.edge, out.slope[0]);
    add(filters.edge, in.smooth, out.slope[1]);
    add(filters.smooth, in.point, out.slope[2]);
    add(filters.point, in.smooth, out.slope[3]);
}

/// The largest colour difference in Rec.709, which is between green and blue.
float largest_color_difference() {
    const auto perceived = [](glm::vec3 linear) { return perceived_from_opponent(opponent_from_linear(linear)); };
    return std::pow(perceived_distance(perceived({0, 1, 0}), perceived({0, 0, 1})), kColorExponent);
}

/// Colour difference of section 4.1.3, 0..1.
float color_difference(const PerceivedRow& a, const PerceivedRow& b, std::size_t x) {
    static const float largest = largest_color_difference();
    const auto perceived = [x](const PerceivedRow& row) {
        return perceived_from_opponent({row.color[0][x], row.color[1][x], row.color[2][x]});
    };
    const float difference = std::pow(perceived_distance(perceived(a), perceived(b)), kColorExponent);
    const float knee = kColorKnee * largest;
    if (difference < knee) return kColorKneeValue * difference / knee;
    return std::min(kColorKneeValue + (difference - knee) / (largest - knee) * (1.0f - kColorKneeValue), 1.0f);
}

/// Feature difference of section 4.2, 0..1. Features are detected in (lightness + 16) / 116, which is 0..1;
/// derivatives scale equally.
float feature_difference(const PerceivedRow& a, const PerceivedRow& b, std::size_t x) {
    const auto strength = [x](const PerceivedRow& row, std::size_t first) {
        const float along_x = row.slope[first][x], along_y = row.slope[first + 1][x];
        return std::sqrt(along_x * along_x + along_y * along_y) / 116.0f;
    };
    const float edges = std::abs(strength(a, 0) - strength(b, 0));
    const float points = std::abs(strength(a, 2) - strength(b, 2));
    return std::min(std::pow(std::max(edges, points) / std::numbers::sqrt2_v<float>, kFeatureExponent), 1.0f);
}

void raise_band(Image& map, const Image& reference, const Image& test, const ShownColor& shown,
                const FlipFilters& filters, Band band) {
    const int first = std::max(band.first - filters.radius(), 0);
    const int end = std::min(band.first + band.count + filters.radius(), map.height);
    const RowFiltered a = filter_rows(reference, {first, end - first}, shown, filters);
    const RowFiltered b = filter_rows(test, {first, end - first}, shown, filters);
    PerceivedRow perceived_a, perceived_b;
    for (int y = band.first; y < band.first + band.count; ++y) {
        filter_columns(a, y, filters, map.height, perceived_a);
        filter_columns(b, y, filters, map.height, perceived_b);
        float* row = map.at(0, y);
        for (std::size_t x = 0; x < std::size_t(map.width); ++x) {
            // Section 4.3: different features make a colour difference more visible.
            const float flip = std::pow(color_difference(perceived_a, perceived_b, x),
                                        1.0f - feature_difference(perceived_a, perceived_b, x));
            row[x] = std::max(row[x], flip);
        }
    }
}

}  // namespace

void check_flip_input(const Image& reference, const Image& test, double pixels_per_degree) {
    const auto described = [](const Image& image) {
        return fmt::format("{} x {} pixels of {} channels", image.width, image.height, image.channels);
    };
    if (reference.channels != 3 || reference.width < 1 || reference.height < 1)
        throw Error(fmt::format("FLIP compares RGB images, not {}", described(reference)));
    if (test.channels != 3 || test.width != reference.width || test.height != reference.height)
        throw Error(fmt::format("FLIP compares images of one size: {} and {}", described(reference), described(test)));
    if (!(pixels_per_degree >= 1.0 && std::isfinite(pixels_per_degree)))
        throw Error(fmt::format("FLIP: {} pixels per degree; at least 1 is needed", pixels_per_degree));
}

void raise_to_flip(Image& map, const Image& reference, const Image& test, const ShownColor& shown,
                   double pixels_per_degree) {
    const FlipFilters filters = flip_filters(pixels_per_degree);
    // Bands overlap by the filters' radius, so taller bands duplicate less work.
    const int rows = std::max(64, 4 * filters.radius());
    tbb::parallel_for(0, (map.height + rows - 1) / rows, [&](int i) {
        const int first = i * rows;
        raise_band(map, reference, test, shown, filters, {first, std::min(rows, map.height - first)});
    });
}

}  // namespace pellucid
