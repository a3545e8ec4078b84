// Filters of FLIP: Andersson et al. 2020, section 4.1.2 (contrast sensitivity) and 4.2.1 (features).
#include "measure/flip_filters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace pellucid {
namespace {

/// Term a sqrt(pi / b) exp(-pi^2 x^2 / b) of a filter, x in degrees. Table 1 of the paper: fits of the contrast
/// sensitivity functions of Johnson and Fairchild 2003, transformed from frequencies to the image plane.
struct SensitivityTerm {
    double a, b;
};
constexpr SensitivityTerm kLightness{1.0, 0.0047};
constexpr SensitivityTerm kRedGreen{1.0, 0.0053};
constexpr std::array<SensitivityTerm, 2> kBlueYellow{{{34.1, 0.04}, {13.5, 0.025}}};

/// Width of the features that the eye detects first, degrees (section 4.2.1).
constexpr double kFeatureWidth = 0.082;

constexpr double kPiSquared = std::numbers::pi * std::numbers::pi;

/// Values of f at the integers from -radius to radius.
template <class Function>
std::vector<double> sampled(int radius, Function&& f) {
    std::vector<double> values;
    for (int x = -radius; x <= radius; ++x) values.push_back(f(double(x)));
    return values;
}

FilterKernel kernel(const std::vector<double>& values, double scale = 1.0) {
    FilterKernel result;
    for (const double value : values) result.weights.push_back(float(scale * value));
    return result;
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

FilterKernel normalized(const std::vector<double>& values) { return kernel(values, 1.0 / sum(values)); }

/// Kernel with negative values scaled to the sum -1, and positive values to the sum 1.
FilterKernel balanced(std::vector<double> values) {
    double negative = 0.0, positive = 0.0;
    for (const double value : values) (value < 0.0 ? negative : positive) += std::abs(value);
    for (double& value : values) value /= value < 0.0 ? negative : positive;
    return kernel(values);
}

void add_sensitivity(FlipFilters& filters, double pixels_per_degree) {
    // Use three standard deviations of the widest term for all.
    const double sigma = std::sqrt(kBlueYellow[0].b / (2.0 * kPiSquared)) * pixels_per_degree;
    const int radius = int(std::ceil(3.0 * sigma));
    const auto gaussian = [&](const SensitivityTerm& term) {
        return sampled(radius, [&](double x) {
            const double degrees = x / pixels_per_degree;
            return std::exp(-kPiSquared * degrees * degrees / term.b);
        });
    };
    filters.lightness = normalized(gaussian(kLightness));
    filters.red_green = normalized(gaussian(kRedGreen));
    double share[2] = {};
    for (std::size_t i = 0; i < kBlueYellow.size(); ++i) {
        const SensitivityTerm& term = kBlueYellow[i];
        const std::vector<double> values = gaussian(term);
        filters.blue_yellow_row[i] = normalized(values);
        share[i] = term.a * std::sqrt(std::numbers::pi / term.b) * sum(values) * sum(values);
    }
    for (std::size_t i = 0; i < kBlueYellow.size(); ++i) {
        const std::vector<double> values = gaussian(kBlueYellow[i]);
        filters.blue_yellow_column[i] = kernel(values, share[i] / ((share[0] + share[1]) * sum(values)));
    }
}

void add_features(FlipFilters& filters, double pixels_per_degree) {
    const double sigma = 0.5 * kFeatureWidth * pixels_per_degree;
    const int radius = int(std::ceil(3.0 * sigma));
    const auto gaussian = [&](double x) { return std::exp(-x * x / (2.0 * sigma * sigma)); };
    filters.smooth = normalized(sampled(radius, gaussian));
    filters.edge = balanced(sampled(radius, [&](double x) { return -x * gaussian(x); }));
    filters.point = balanced(sampled(radius, [&](double x) { return (x * x / (sigma * sigma) - 1.0) * gaussian(x); }));
}

}  // namespace

int FlipFilters::radius() const { return std::max(lightness.radius(), smooth.radius()); }

FlipFilters flip_filters(double pixels_per_degree) {
    FlipFilters filters;
    add_sensitivity(filters, pixels_per_degree);
    add_features(filters, pixels_per_degree);
    return filters;
}

void filter_row(const FilterKernel& kernel, const float* in, float* out, std::size_t pitch) {
    const std::size_t taps = kernel.weights.size();
    for (std::size_t x = 0; x < pitch; x += kFilterBlock) {
        float sums[kFilterBlock] = {};
        for (std::size_t j = 0; j < taps; ++j) {
            const float weight = kernel.weights[j];
            for (std::size_t i = 0; i < kFilterBlock; ++i) sums[i] += weight * in[x + j + i];
        }
        std::copy_n(sums, kFilterBlock, out + x);
    }
}

void add_filtered_column(const FilterKernel& kernel, const float* const* rows, float* out, std::size_t pitch) {
    const std::size_t taps = kernel.weights.size();
    for (std::size_t x = 0; x < pitch; x += kFilterBlock) {
        float sums[kFilterBlock];
        std::copy_n(out + x, kFilterBlock, sums);
        for (std::size_t j = 0; j < taps; ++j) {
            const float weight = kernel.weights[j];
            for (std::size_t i = 0; i < kFilterBlock; ++i) sums[i] += weight * rows[j][x + i];
        }
        std::copy_n(sums, kFilterBlock, out + x);
    }
}

}  // namespace pellucid
