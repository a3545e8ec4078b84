// HDR-FLIP: Andersson, Nilsson, Shirley and Akenine-Moller, "Visualizing Errors in Rendered High Dynamic Range Images",
// Eurographics Short Papers 2021.
#include <pellucid/measure.h>

#include "measure/flip_map.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid {
namespace {

/// Tone curve (k0 x^2 + k1 x + k2) / (k3 x^2 + k4 x + k5): Narkowicz's fit of ACES (2015) with its author's factor 0.6
/// for the original's brightness.
struct ToneCurve {
    double k0 = 0.6 * 0.6 * 2.51, k1 = 0.6 * 0.03, k2 = 0.0;
    double k3 = 0.6 * 0.6 * 2.43, k4 = 0.6 * 0.59, k5 = 0.14;
};
constexpr ToneCurve kAces;

/// Displayed value to which the brightest and the median pixel are exposed (section 4.2: beyond it detail is lost).
constexpr double kUsefulMaximum = 0.85;

/// Larger radiances always display as 1. The square of this bound is finite.
constexpr float kBrightest = 1e9f;

/// Displayed value of a radiance, 0..1.
float tone_mapped(float radiance) {
    if (!(radiance > 0.0f)) return 0.0f;  // includes NaN
    const float x = std::min(radiance, kBrightest);
    const float above = (float(kAces.k0) * x + float(kAces.k1)) * x + float(kAces.k2);
    const float below = (float(kAces.k3) * x + float(kAces.k4)) * x + float(kAces.k5);
    return std::min(above / below, 1.0f);
}

/// The radiance displayed as `shown`: the larger root of the quadratic equation.
double radiance_of_shown(double shown) {
    const double a = kAces.k0 - shown * kAces.k3;
    const double b = kAces.k1 - shown * kAces.k4;
    const double c = kAces.k2 - shown * kAces.k5;
    const double middle = -0.5 * b / a;
    return middle + std::sqrt(middle * middle - c / a);
}

/// Luminance of every pixel (ITU-R BT.709). Negative values and NaN become 0; infinite values are removed.
std::vector<float> luminances(const Image& image) {
    std::vector<float> values;
    values.reserve(image.pixels.size() / 3);
    for (std::size_t i = 0; i + 2 < image.pixels.size(); i += 3) {
        const float* rgb = image.pixels.data() + i;
        const float value = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
        if (!(value > std::numeric_limits<float>::max())) values.push_back(value > 0.0f ? value : 0.0f);
    }
    return values;
}

float median(std::vector<float>& values) {
    const auto middle = values.begin() + std::ptrdiff_t((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

FlipExposures flip_exposures(const Image& reference) {
    if (reference.channels != 3)
        throw Error(fmt::format("FLIP compares RGB images, not {} channels", reference.channels));
    std::vector<float> values = luminances(reference);
    const float brightest = values.empty() ? 0.0f : *std::max_element(values.begin(), values.end());
    if (brightest == 0.0f) return {};
    float typical = median(values);
    if (typical == 0.0f) {  // no exposure brightens black: use the median of the other pixels
        std::erase(values, 0.0f);
        typical = median(values);
    }
    const double bright_enough = radiance_of_shown(kUsefulMaximum);
    FlipExposures exposures;
    exposures.start = std::log2(bright_enough / double(brightest));
    exposures.stop = std::log2(bright_enough / double(typical));
    exposures.count = std::max(2, int(std::ceil(exposures.stop - exposures.start)));
    return exposures;
}

Image flip_hdr(const Image& reference, const Image& test, const FlipExposures& exposures, double pixels_per_degree) {
    check_flip_input(reference, test, pixels_per_degree);
    if (exposures.count < 1 || !std::isfinite(exposures.start) || !std::isfinite(exposures.stop)) {
        throw Error(fmt::format("HDR-FLIP: {} exposures from {} to {} stops", exposures.count, exposures.start,
                                exposures.stop));
    }
    Image map(reference.width, reference.height, 1);
    const double step = exposures.count > 1 ? (exposures.stop - exposures.start) / (exposures.count - 1) : 0.0;
    for (int i = 0; i < exposures.count; ++i) {
        const float scale = float(std::exp2(exposures.start + i * step));
        const ShownColor shown = [scale](glm::vec3 rgb) {
            return glm::vec3(tone_mapped(scale * rgb.x), tone_mapped(scale * rgb.y), tone_mapped(scale * rgb.z));
        };
        raise_to_flip(map, reference, test, shown, pixels_per_degree);
    }
    return map;
}

}  // namespace pellucid
