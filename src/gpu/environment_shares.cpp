#include "gpu/environment_shares.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace pellucid {
namespace {

using std::numbers::pi;

constexpr int kMostColumns = 256, kMostRows = 128;

double luminance(const glm::vec3& c) { return 0.2126 * double(c.r) + 0.7152 * double(c.g) + 0.0722 * double(c.b); }

/// Mean luminance per cell, rows from the top.
struct Grid {
    int columns, rows;
    std::vector<double> cells;
};

/// Integral up to `x` of the tent filter of linear interpolation for a texel at 0.
double tent_up_to(double x) {
    x = std::clamp(x, -1.0, 1.0);
    return x < 0.0 ? 0.5 * (1.0 + x) * (1.0 + x) : 1.0 - 0.5 * (1.0 - x) * (1.0 - x);
}

/// Means of a linearly interpolated row of values over `count` equal cells.
std::vector<double> means(const std::vector<double>& values, int count, bool wraps) {
    const int n = int(values.size());
    const double width = double(n) / count;
    std::vector<double> result;
    for (int cell = 0; cell < count; ++cell) {
        const double low = cell * width - 0.5, high = low + width;  // texel i lies at i
        double sum = 0.0;
        for (int i = int(std::floor(low)); i <= int(std::ceil(high)); ++i) {
            const int at = wraps ? (i + n) % n : std::clamp(i, 0, n - 1);
            sum += values[std::size_t(at)] * (tent_up_to(high - i) - tent_up_to(low - i));
        }
        result.push_back(sum / width);
    }
    return result;
}

Grid tabulate_map(const Image& map) {
    Grid grid{std::min(map.width, kMostColumns), std::min(map.height, kMostRows), {}};
    std::vector<std::vector<double>> rows;
    for (int y = 0; y < map.height; ++y) {
        std::vector<double> row;
        for (int x = 0; x < map.width; ++x)
            row.push_back(luminance({map.at(x, y)[0], map.at(x, y)[1], map.at(x, y)[2]}));
        rows.push_back(means(row, grid.columns, true));
    }
    grid.cells.resize(std::size_t(grid.columns) * std::size_t(grid.rows));
    for (int x = 0; x < grid.columns; ++x) {
        std::vector<double> column;
        for (const std::vector<double>& row : rows) column.push_back(row[std::size_t(x)]);
        column = means(column, grid.rows, false);
        for (int y = 0; y < grid.rows; ++y) grid.cells[std::size_t(y * grid.columns + x)] = column[std::size_t(y)];
    }
    return grid;
}

Grid tabulate_formula(Environment environment) {
    constexpr int kPerSide = 8;
    environment.rotation = 0.0f;
    environment.intensity = 1.0f;
    Grid grid{kMostColumns, kMostRows, std::vector<double>(std::size_t(kMostColumns) * kMostRows)};
    for (int y = 0; y < kMostRows * kPerSide; ++y) {
        const double colatitude = (y + 0.5) / (kMostRows * kPerSide) * pi;
        for (int x = 0; x < kMostColumns * kPerSide; ++x) {
            const double longitude = ((x + 0.5) / (kMostColumns * kPerSide) - 0.5) * 2.0 * pi;
            const glm::vec3 d(std::sin(colatitude) * std::cos(longitude), std::cos(colatitude),
                              std::sin(colatitude) * std::sin(longitude));
            grid.cells[std::size_t(y / kPerSide * kMostColumns + x / kPerSide)] +=
                luminance(radiance(environment, d)) / (kPerSide * kPerSide);
        }
    }
    return grid;
}

/// Appends the cumulative shares of the weights. Returns the sum of the weights.
double append_shares(const double* weights, int count, std::vector<std::uint32_t>& words) {
    double sum = 0.0, running = 0.0;
    for (int i = 0; i < count; ++i) sum += weights[i];
    for (int i = 0; i < count; ++i) {
        running += weights[i];
        const bool last = i + 1 == count || !(sum > 0.0);
        words.push_back(std::bit_cast<std::uint32_t>(last ? 1.0f : float(running / sum)));
    }
    return sum;
}

}  // namespace

std::optional<EnvironmentShares> tabulate_environment(const Device& device, const Environment& environment) {
    if (environment.intensity == 0.0f) return std::nullopt;
    const bool map = environment.kind == Environment::Kind::kMap;
    const Grid grid = map ? tabulate_map(environment.map) : tabulate_formula(environment);
    std::vector<std::uint32_t> columns, words{std::uint32_t(grid.columns), std::uint32_t(grid.rows)};
    std::vector<double> rows;
    for (int y = 0; y < grid.rows; ++y) {
        const double step = pi / grid.rows, solid_angle = 4.0 * pi * std::sin((y + 0.5) * step) * std::sin(0.5 * step);
        const double sum = append_shares(&grid.cells[std::size_t(y * grid.columns)], grid.columns, columns);
        rows.push_back(sum * solid_angle / grid.columns);
    }
    const double total = append_shares(rows.data(), grid.rows, words);
    if (!(total > 0.0)) return std::nullopt;
    words.insert(words.end(), columns.begin(), columns.end());
    Buffer buffer(device, "the environment's shares", words.size() * sizeof(words[0]),
                  vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst);
    upload(device, buffer, std::as_bytes(std::span(words)));
    return EnvironmentShares{std::move(buffer), float(total * double(environment.intensity))};
}

}  // namespace pellucid
