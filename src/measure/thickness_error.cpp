#include <pellucid/error.h>
#include <pellucid/measure.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pellucid {

ThicknessError thickness_error(const Image& truth, const Image& thickness, Image* difference) {
    if (truth.width != thickness.width || truth.height != thickness.height || truth.channels != 1 ||
        thickness.channels != 1) {
        throw Error(fmt::format("thickness: {}x{} of {} channels cannot be compared with {}x{} of {}", truth.width,
                                truth.height, truth.channels, thickness.width, thickness.height, thickness.channels));
    }
    if (difference != nullptr) *difference = Image(truth.width, truth.height, 1);
    ThicknessError error;
    std::vector<double> off;
    double sum = 0.0, true_sum = 0.0;
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        const bool a = truth.pixels[i] >= 0.0f, b = thickness.pixels[i] >= 0.0f;
        if (!a && !b) continue;
        const double d_true = a ? double(truth.pixels[i]) : 0.0, d = b ? double(thickness.pixels[i]) : 0.0;
        error.points += a && b ? 1 : 0;
        error.unmatched += a != b ? 1 : 0;
        off.push_back(std::abs(d - d_true));
        sum += off.back();
        true_sum += d_true;
        if (difference != nullptr) difference->pixels[i] = float(off.back());
    }
    if (off.empty()) return error;
    error.relative = true_sum > 0.0 ? sum / true_sum : sum > 0.0 ? 1.0 : 0.0;
    error.mean = sum / double(off.size());
    std::sort(off.begin(), off.end());
    error.p95 = off[std::min(off.size() - 1, std::size_t(std::ceil(0.95 * double(off.size()))) - 1)];
    error.largest = off.back();
    return error;
}

}  // namespace pellucid
