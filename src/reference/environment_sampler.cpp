#include "reference/environment_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace pellucid::reference {
namespace {

using std::numbers::pi;

double luminance(const glm::vec3& c) { return 0.2126 * double(c.r) + 0.7152 * double(c.g) + 0.0722 * double(c.b); }

/// Luminance of the cells of an equirectangular grid, rows from the top.
struct Grid {
    std::size_t width, height;
    std::vector<double> luminance;
};

/// One cell per texel, with the mean of the bilinear interpolation in it. Neighbours reach half-way into a texel, so
/// three texels in a row have weights 1/8, 6/8 and 1/8.
Grid tabulate_map(const Image& map) {
    Grid grid{std::size_t(map.width), std::size_t(map.height), {}};
    grid.luminance.resize(grid.width * grid.height);
    const auto mean_along_row = [&](int x, int y) {
        const auto at = [&](int i) {
            const float* p = map.at((i + map.width) % map.width, y);
            return luminance({p[0], p[1], p[2]});
        };
        return 0.125 * at(x - 1) + 0.75 * at(x) + 0.125 * at(x + 1);
    };
    for (int y = 0; y < map.height; ++y) {
        const int above = std::max(y - 1, 0), below = std::min(y + 1, map.height - 1);
        for (int x = 0; x < map.width; ++x) {
            grid.luminance[std::size_t(y) * grid.width + std::size_t(x)] =
                0.125 * mean_along_row(x, above) + 0.75 * mean_along_row(x, y) + 0.125 * mean_along_row(x, below);
        }
    }
    return grid;
}

/// World direction. A right-handed rotation of the environment about +Y reduces longitudes.
glm::dvec3 direction_from_equirect(double u, double cos_colatitude, double rotation) {
    const double longitude = (u - 0.5) * 2.0 * pi - rotation;
    const double radius = std::sqrt(std::max(1.0 - cos_colatitude * cos_colatitude, 0.0));
    return {radius * std::cos(longitude), cos_colatitude, radius * std::sin(longitude)};
}

/// Cells of 0.7 degrees. The sun of the built-in sky covers a few of them.
Grid tabulate_formula(const Environment& environment) {
    constexpr int kWidth = 512, kHeight = 256, kPerSide = 2;
    Grid grid{kWidth, kHeight, std::vector<double>(std::size_t(kWidth) * kHeight)};
    for (int y = 0; y < kHeight * kPerSide; ++y) {
        const double cos_colatitude = std::cos((y + 0.5) / (kHeight * kPerSide) * pi);
        for (int x = 0; x < kWidth * kPerSide; ++x) {
            const glm::dvec3 d =
                direction_from_equirect((x + 0.5) / (kWidth * kPerSide), cos_colatitude, double(environment.rotation));
            grid.luminance[std::size_t(y / kPerSide) * kWidth + std::size_t(x / kPerSide)] +=
                luminance(radiance(environment, glm::vec3(d))) / (kPerSide * kPerSide);
        }
    }
    return grid;
}

/// Converts weights into cumulative shares: value i + 1 is the share of the first i + 1 weights.
template <class Real>
double accumulate_shares(std::span<const double> weights, std::span<Real> shares) {
    double sum = 0.0;
    for (const double weight : weights) sum += weight;
    double running = 0.0;
    shares[0] = Real(0);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        running += weights[i];
        shares[i + 1] = sum > 0.0 ? Real(running / sum) : Real(double(i + 1) / double(weights.size()));
    }
    shares.back() = Real(1);
    return sum;
}

/// Index of the interval that contains x, and the position of x in it, 0..1. `shares` ascends from 0 to 1.
template <class Real>
std::pair<std::size_t, double> find_interval(std::span<const Real> shares, double x) {
    const auto above = std::upper_bound(shares.begin() + 1, shares.end() - 1, x,
                                        [](double value, Real share) { return value < double(share); });
    const auto i = std::size_t(above - shares.begin()) - 1;
    const double low = double(shares[i]), high = double(shares[i + 1]);
    return {i, high > low ? std::min((x - low) / (high - low), 1.0) : 0.5};
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(const Environment& environment) {
    const Grid grid =
        environment.kind == Environment::Kind::kMap ? tabulate_map(environment.map) : tabulate_formula(environment);
    width_ = grid.width;
    height_ = grid.height;
    rotation_ = std::remainder(double(environment.rotation), 2.0 * pi);
    columns_.resize((width_ + 1) * height_);
    std::vector<double> row_light(height_);
    for (std::size_t y = 0; y < height_; ++y) {
        const std::span<float> shares(columns_.data() + y * (width_ + 1), width_ + 1);
        row_light[y] = row_solid_angle(y) *
                       accumulate_shares<float>(std::span(grid.luminance).subspan(y * width_, width_), shares);
    }
    rows_.resize(height_ + 1);
    const double light = accumulate_shares<double>(row_light, rows_);
    if (!(light > 0.0) || environment.intensity == 0.0f) rows_.clear();
}

double EnvironmentSampler::row_solid_angle(std::size_t row) const {
    const double step = pi / double(height_);
    // 2 pi (cos a - cos b) without cancellation near the poles.
    return 4.0 * pi * std::sin((double(row) + 0.5) * step) * std::sin(0.5 * step);
}

std::span<const float> EnvironmentSampler::columns(std::size_t row) const {
    return std::span(columns_).subspan(row * (width_ + 1), width_ + 1);
}

double EnvironmentSampler::cell_pdf(std::size_t column, std::size_t row) const {
    const std::span<const float> shares = columns(row);
    const double share = (rows_[row + 1] - rows_[row]) * (double(shares[column + 1]) - double(shares[column]));
    return share * double(width_) / row_solid_angle(row);
}

EnvironmentSampler::Sample EnvironmentSampler::sample(Random& random) const {
    const glm::dvec2 u = random.next2();
    const auto [row, down] = find_interval<double>(rows_, u.y);
    const auto [column, across] = find_interval<float>(columns(row), u.x);
    const double step = pi / double(height_);
    const double top = std::cos(double(row) * step), bottom = std::cos(double(row + 1) * step);
    Sample sample;
    sample.direction =
        direction_from_equirect((double(column) + across) / double(width_), top + down * (bottom - top), rotation_);
    sample.pdf = cell_pdf(column, row);
    return sample;
}

double EnvironmentSampler::pdf(const glm::dvec3& direction) const {
    if (dark()) return 0.0;
    const double longitude = direction.x == 0.0 && direction.z == 0.0 ? 0.0 : std::atan2(direction.z, direction.x);
    double u = 0.5 + (longitude + rotation_) / (2.0 * pi);
    if (u < 0.0) u += 1.0;
    if (u > 1.0) u -= 1.0;
    const double v = std::acos(std::clamp(direction.y, -1.0, 1.0)) / pi;
    const auto index = [](double x, std::size_t count) {
        return std::min(std::size_t(x * double(count)), count - 1);  // x = 1 belongs to the last interval
    };
    return cell_pdf(index(u, width_), index(v, height_));
}

}  // namespace pellucid::reference
