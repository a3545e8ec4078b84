#include "render/adaptive_sampling.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

constexpr float kMiddleGrey = 0.18f;
constexpr int kAround = 2;  // filter radius, pixels

/// Box filter of one channel, separable.
Image mean_around(const Image& image) {
    Image across(image.width, image.height, 1), around = across;
    const auto blur = [](const Image& from, Image& to, int step_x, int step_y) {
        for (int y = 0; y < from.height; ++y) {
            for (int x = 0; x < from.width; ++x) {
                float sum = 0.0f, count = 0.0f;
                for (int i = -kAround; i <= kAround; ++i) {
                    const int near_x = x + i * step_x, near_y = y + i * step_y;
                    if (near_x < 0 || near_y < 0 || near_x >= from.width || near_y >= from.height) continue;
                    sum += *from.at(near_x, near_y);
                    count += 1.0f;
                }
                *to.at(x, y) = sum / count;
            }
        }
    };
    blur(image, across, 1, 0);
    blur(across, around, 0, 1);
    return around;
}

}  // namespace

PixelNoise::PixelNoise(const Image& mean, const Image& standard_error, std::uint32_t samples)
    : samples_(samples), mean_(mean), deviations_(standard_error) {
    for (float& value : deviations_.pixels) value *= value * float(samples) * float(samples - 1);
}

void PixelNoise::add(const Image& sample) {
    if (samples_ == 0) mean_ = deviations_ = Image(sample.width, sample.height, 3);
    ++samples_;
    for (std::size_t i = 0; i < sample.pixels.size(); ++i) {
        const float from_old = sample.pixels[i] - mean_.pixels[i];
        mean_.pixels[i] += from_old / float(samples_);
        deviations_.pixels[i] += from_old * (sample.pixels[i] - mean_.pixels[i]);
    }
}

std::vector<std::uint32_t> PixelNoise::samples_for(float error, float exposure_ev, std::uint32_t most) const {
    Image variance(mean_.width, mean_.height, 1);
    for (std::size_t i = 0; i < variance.pixels.size(); ++i) {
        const float* of_pixel = &deviations_.pixels[3 * i];
        variance.pixels[i] = *std::max_element(of_pixel, of_pixel + 3) / float(samples_ - 1);
    }
    const Image around = mean_around(variance);
    const float grey = kMiddleGrey / std::exp2(exposure_ev);
    std::vector<std::uint32_t> wanted(variance.pixels.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const float* rgb = &mean_.pixels[3 * i];
        const double luminance = 0.2126 * double(rgb[0]) + 0.7152 * double(rgb[1]) + 0.0722 * double(rgb[2]);
        const double allowed = double(error) * (luminance + double(grey));
        const double needed = double(std::max(variance.pixels[i], around.pixels[i])) / (allowed * allowed);
        // NaN or infinity: light beyond the range of floats counts as maximally noisy.
        wanted[i] =
            needed < double(most) ? std::max(std::min(kFewestSamples, most), std::uint32_t(std::ceil(needed))) : most;
    }
    return wanted;
}

}  // namespace pellucid
