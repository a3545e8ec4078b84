#pragma once

// Adaptive sampling: the noise of each pixel determines its number of samples.
#include <pellucid/image.h>

#include <cstdint>
#include <vector>

namespace pellucid {

/// Pilot samples per pixel that estimate its noise. They are not part of the image. If they were, a pixel would stop
/// early when it had missed rare light, which would bias it.
constexpr std::uint32_t kPilotSamples = 8;
constexpr std::uint32_t kFewestSamples = 4;  ///< least samples of a pixel

/// Mean and variance of single samples of every pixel (Welford 1962).
class PixelNoise {
public:
    PixelNoise() = default;
    /// Starts from the mean and standard error of a number of samples.
    PixelNoise(const Image& mean, const Image& standard_error, std::uint32_t samples);

    /// Adds a sample, RGB, scene-linear, of equal size.
    void add(const Image& sample);

    /// Samples that reduce the standard error of each pixel to `error`, rows from the top. The error is that of its
    /// noisiest channel, as a share of luminance plus middle grey (0.18 at exposure 0). The variance is the larger of
    /// the pixel's own and the mean over 5x5 pixels around it. Few samples of one pixel may have missed rare light.
    /// Result: kFewestSamples to `most`.
    std::vector<std::uint32_t> samples_for(float error, float exposure_ev, std::uint32_t most) const;

private:
    std::uint32_t samples_ = 0;
    Image mean_, deviations_;  // `deviations_`: sum of squared deviations from the mean
};

}  // namespace pellucid
