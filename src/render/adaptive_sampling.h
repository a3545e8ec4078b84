#pragma once

// As many samples of every pixel as its noise asks for.
#include <pellucid/image.h>

#include <cstdint>
#include <vector>

namespace pellucid {

/// Samples of every pixel that tell how noisy it is. They are no part of the picture: a pixel whose number of samples
/// followed from these very samples would be biased, as it stops the sooner the less it has seen of rare light.
constexpr std::uint32_t kPilotSamples = 8;
constexpr std::uint32_t kFewestSamples = 4;  ///< of a pixel

/// Mean and variance of what single samples of every pixel differ by (Welford 1962).
class PixelNoise {
public:
    PixelNoise() = default;
    /// What a number of samples have for a mean and its standard error.
    PixelNoise(const Image& mean, const Image& standard_error, std::uint32_t samples);

    /// RGB, scene-linear, of equal size.
    void add(const Image& sample);

    /// How many samples take the standard error of each pixel to `error`, rows from the top: that of its noisiest channel,
    /// as a share of its luminance and middle grey (0.18 at an exposure of 0). Variances are those of the pixel or of the
    /// 5x5 pixels around it, whichever is more: few samples may have missed what is rare. kFewestSamples to `most`.
    std::vector<std::uint32_t> samples_for(float error, float exposure_ev, std::uint32_t most) const;

private:
    std::uint32_t samples_ = 0;
    Image mean_, deviations_;  // sum of the squared deviations from the mean
};

}  // namespace pellucid
