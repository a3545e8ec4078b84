// How many samples a pixel needs follows from the variance of a few: the standard error of n is its root over n.
#include "render/adaptive_sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid::test {
namespace {

constexpr std::uint32_t kMost = 1000;

/// A grey picture with one pixel of another value in its middle.
Image grey(float value, float middle) {
    Image image(11, 11, 3);
    std::fill(image.pixels.begin(), image.pixels.end(), value);
    std::fill_n(image.at(5, 5), 3, middle);
    return image;
}

std::uint32_t at(const std::vector<std::uint32_t>& counts, int x, int y) { return counts[std::size_t(11 * y + x)]; }

/// The middle changes between 1 - d and 1 + d: a variance of d^2 * n / (n - 1).
PixelNoise noise_of(float d) {
    PixelNoise noise;
    for (std::uint32_t i = 0; i < kPilotSamples; ++i) noise.add(grey(1.0f, i % 2 == 0 ? 1.0f - d : 1.0f + d));
    return noise;
}

TEST(AdaptiveSampling, TakesTheStandardErrorDownToWhatWasAsked) {
    const double variance = 0.5 * 0.5 * kPilotSamples / (kPilotSamples - 1.0);
    const double allowed = 0.05 * (1.0 + 0.18);
    const auto counts = noise_of(0.5f).samples_for(0.05f, 0.0f, kMost);
    EXPECT_NEAR(at(counts, 5, 5), std::ceil(variance / (allowed * allowed)), 1.0);
    EXPECT_NEAR(at(counts, 3, 7), std::ceil(variance / 25.0 / (allowed * allowed)), 1.0);  // of the 5x5 around it
    EXPECT_EQ(at(counts, 2, 5), kFewestSamples);
    EXPECT_EQ(at(counts, 0, 0), kFewestSamples);
}

TEST(AdaptiveSampling, ExposureSaysWhatMiddleGreyIs) {
    const auto dark = noise_of(0.5f).samples_for(0.05f, 2.0f, kMost);
    EXPECT_NEAR(at(dark, 5, 5), std::ceil(0.25 * 8.0 / 7.0 / std::pow(0.05 * (1.0 + 0.18 / 4.0), 2.0)), 1.0);
}

TEST(AdaptiveSampling, KeepsToTheMost) {
    const auto counts = noise_of(0.9f).samples_for(0.001f, 0.0f, 77);
    EXPECT_EQ(at(counts, 5, 5), 77u);
    EXPECT_EQ(*std::max_element(counts.begin(), counts.end()), 77u);
    const auto few = noise_of(0.9f).samples_for(0.001f, 0.0f, 2);
    EXPECT_EQ(at(few, 0, 0), 2u);
}

TEST(AdaptiveSampling, InfiniteLightIsAsNoisyAsCanBe) {
    const auto counts = noise_of(std::numeric_limits<float>::infinity()).samples_for(0.1f, 0.0f, kMost);
    EXPECT_EQ(at(counts, 5, 5), kMost);
}

TEST(AdaptiveSampling, AMeanWithItsErrorSaysTheSame) {
    const float d = 0.5f;
    const Image mean = grey(1.0f, 1.0f), error = grey(0.0f, d / std::sqrt(float(kPilotSamples - 1)));
    EXPECT_EQ(PixelNoise(mean, error, kPilotSamples).samples_for(0.05f, 0.0f, kMost),
              noise_of(d).samples_for(0.05f, 0.0f, kMost));
}

}  // namespace
}  // namespace pellucid::test
