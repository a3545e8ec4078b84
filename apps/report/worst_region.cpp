#include "report/worst_region.h"

#include <algorithm>
#include <vector>

namespace pellucid {
namespace {

double counted(float value) { return value > 0.0f ? double(value) : 0.0; }

/// Adds a row of the map, `sign` times, to the sums of its columns.
void add_row(std::vector<double>& columns, const Image& map, int y, double sign) {
    for (int x = 0; x < map.width; ++x) columns[std::size_t(x)] += sign * counted(*map.at(x, y));
}

}  // namespace

int region_size(int width, int height) {
    const int shorter = std::min(width, height);
    return std::min(shorter, std::max(32, shorter / 16));
}

std::optional<Region> worst_region(const Image& map) {
    const int size = region_size(map.width, map.height);
    // Slide sums over `size` rows of each column, and over `size` of these sums, so that every position costs the
    // same.
    std::vector<double> columns(std::size_t(map.width), 0.0);
    for (int y = 0; y < size; ++y) add_row(columns, map, y, 1.0);
    Region worst;
    double greatest = 0.0;
    for (int y = 0; y + size <= map.height; ++y) {
        double sum = 0.0;
        for (int x = 0; x < map.width; ++x) {
            sum += columns[std::size_t(x)];
            if (x >= size) sum -= columns[std::size_t(x - size)];
            if (x + 1 < size || sum <= greatest) continue;
            greatest = sum;
            worst = {x + 1 - size, y, size, sum / (double(size) * size)};
        }
        if (y + size == map.height) break;
        add_row(columns, map, y + size, 1.0);
        add_row(columns, map, y, -1.0);
    }
    if (worst.size == 0) return std::nullopt;
    return worst;
}

}  // namespace pellucid
