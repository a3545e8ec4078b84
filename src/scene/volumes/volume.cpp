#include <pellucid/volume.h>

#include <pellucid/error.h>

#include "core/fail.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace pellucid {
namespace {

template <class T, class Good>
void check_field(const Volume& volume, const char* field, const std::vector<T>& values, const char* range, Good good) {
    if (values.empty()) return;
    if (values.size() != volume.voxel_count())
        throw Error(fmt::format("volume '{}': {} has {} voxels, the grid {}", one_line(volume.name), field,
                                values.size(), volume.voxel_count()));
    const auto bad = std::find_if(values.begin(), values.end(), [&](const T& value) { return !good(value); });
    if (bad == values.end()) return;
    const auto i = std::size_t(bad - values.begin());
    throw Error(fmt::format("volume '{}': {} at voxel ({}, {}, {}) is not {}", one_line(volume.name), field,
                            i % volume.size.x, i / volume.size.x % volume.size.y, i / volume.size.x / volume.size.y,
                            range));
}

bool is_amount(float value) { return value >= 0.0f && std::isfinite(value); }
bool is_amount(const glm::vec3& v) { return is_amount(v.x) && is_amount(v.y) && is_amount(v.z); }

/// Memory available without swapping, bytes; 0 if the system does not report it.
double free_bytes() {
    std::ifstream file("/proc/meminfo");
    std::string word;
    double kib = 0.0;
    while (file >> word)
        if (word == "MemAvailable:" && file >> kib) return 1024.0 * kib;
    return 0.0;
}

/// Smooths along one axis of the grid. `weights`: one half of a symmetric kernel.
void smooth_axis(const Volume& volume, std::vector<float>& values, int axis, const std::vector<double>& weights) {
    const std::size_t steps[3] = {1, volume.size.x, std::size_t(volume.size.x) * volume.size.y};
    const std::size_t step = steps[axis];
    const int length = int(volume.size[axis]), reach = int(weights.size()) - 1;
    const unsigned across = volume.size[(axis + 1) % 3], along = volume.size[(axis + 2) % 3];
    std::vector<double> line(std::size_t(length) + 2 * std::size_t(reach));
    for (unsigned a = 0; a < across; ++a) {
        for (unsigned b = 0; b < along; ++b) {
            float* const first = &values[a * steps[(axis + 1) % 3] + b * steps[(axis + 2) % 3]];
            for (int i = 0; i < int(line.size()); ++i)
                line[std::size_t(i)] = double(first[std::size_t(std::clamp(i - reach, 0, length - 1)) * step]);
            for (int i = 0; i < length; ++i) {
                const double* const at = &line[std::size_t(i + reach)];
                double sum = weights[0] * at[0];
                for (int k = 1; k <= reach; ++k) sum += weights[std::size_t(k)] * (at[-k] + at[k]);
                first[std::size_t(i) * step] = float(sum);
            }
        }
    }
}

}  // namespace

void check_volume(const Volume& volume) {
    const auto require = [&](bool holds, const char* promise) {
        if (!holds) throw Error(fmt::format("volume '{}': {}", one_line(volume.name), promise));
    };
    require(volume.size.x >= 2 && volume.size.y >= 2 && volume.size.z >= 2, "needs at least 2 voxels along every axis");
    require(std::isfinite(volume.voxel) && volume.voxel > 0.0f, "the edge of a voxel must be above 0");
    for (int k = 0; k < 3; ++k)
        require(std::isfinite(volume.low[k]) && std::isfinite(volume.high()[k]), "its box is not finite");
    require(volume.n_red.empty() == volume.n_blue.empty() && (volume.n_red.empty() || !volume.n.empty()),
            "the index is given for one colour, or for all three");
    const auto is_index = [](float n) { return n >= 0.1f && n <= 100.0f; };
    check_field(volume, "n", volume.n, "within 0.1..100", is_index);
    check_field(volume, "n_red", volume.n_red, "within 0.1..100", is_index);
    check_field(volume, "n_blue", volume.n_blue, "within 0.1..100", is_index);
    const auto amount = [](const auto& value) { return is_amount(value); };
    check_field(volume, "sigma_a", volume.sigma_a, "finite and not negative", amount);
    check_field(volume, "sigma_s", volume.sigma_s, "finite and not negative", amount);
    check_field(volume, "g", volume.g, "within -1..1", [](float g) { return g > -1.0f && g < 1.0f; });
    check_field(volume, "emission", volume.emission, "finite and not negative", amount);
    check_field(volume, "boundary", volume.boundary, "finite and not negative", amount);
}

void check_volume_fits(const std::string& what, glm::uvec3 size, std::size_t bytes_per_voxel) {
    const double bytes = double(size.x) * size.y * size.z * double(bytes_per_voxel), available = free_bytes();
    if (available == 0.0 || bytes <= available) return;
    constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;
    throw Error(
        fmt::format("{}: {} x {} x {} voxels need {:.4g} GiB, of which {:.4g} GiB are free; take a lower resolution",
                    one_line(what), size.x, size.y, size.z, bytes / kGiB, available / kGiB));
}

void smooth_index(Volume& volume, float sigma) {
    if (!(sigma >= 0.0f && sigma <= 16.0f)) throw Error(fmt::format("smoothing must be 0 to 16 voxels, not {}", sigma));
    if (sigma == 0.0f) return;
    std::vector<double> weights;
    double total = 0.0;
    for (int k = 0; k <= int(std::ceil(4.0f * sigma)); ++k) {
        weights.push_back(std::exp(-0.5 * (k / double(sigma)) * (k / double(sigma))));
        total += (k == 0 ? 1.0 : 2.0) * weights.back();
    }
    for (double& weight : weights) weight /= total;
    for (std::vector<float>* field : {&volume.n, &volume.n_red, &volume.n_blue, &volume.boundary})
        for (int axis = 0; axis < 3 && !field->empty(); ++axis) smooth_axis(volume, *field, axis, weights);
}

}  // namespace pellucid
