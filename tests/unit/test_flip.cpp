#include "test_files.h"

#include <pellucid/error.h>
#include <pellucid/measure.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace pellucid {
namespace {

Image filled(int width, int height, glm::vec3 color) {
    Image image(width, height, 3);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = color[int(i % 3)];
    return image;
}

Image noise(int width, int height, unsigned seed) {
    Image image(width, height, 3);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(0.0f, 1.0f);
    for (float& p : image.pixels) p = value(random);
    return image;
}

Image transposed(const Image& image) {
    Image result(image.height, image.width, image.channels);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) std::copy_n(image.at(x, y), image.channels, result.at(y, x));
    return result;
}

Image scaled(Image image, float factor) {
    for (float& p : image.pixels) p *= factor;
    return image;
}

float srgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// The fitted ACES curve as a display with the sRGB curve is given it.
Image tone_mapped(Image image, double exposure) {
    for (float& p : image.pixels) {
        const float x = 0.6f * p * float(std::exp2(exposure));
        p = srgb(std::min(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 1.0f));
    }
    return image;
}

float largest_difference(const Image& a, const Image& b) {
    float largest = 0.0f;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) largest = std::max(largest, std::abs(a.pixels[i] - b.pixels[i]));
    return largest;
}

std::string error_of(const Image& a, const Image& b, double pixels_per_degree = 67.0) {
    try {
        flip_ldr(a, b, pixels_per_degree);
        return {};
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(FlipLdr, OfficialMeans) {
    const std::filesystem::path folder = test::data_folder() / "flip";
    if (!std::filesystem::exists(folder / "reference.png")) GTEST_SKIP() << "no flip/ in $PELLUCID_TEST_DATA";
    const auto mean_of = [&](const char* a, const char* b) {
        return mean(flip_ldr(read_image(folder / a), read_image(folder / b)));
    };
    EXPECT_NEAR(mean_of("reference.png", "test.png"), 0.286338, 1e-4);
    EXPECT_NEAR(mean_of("black.png", "white.png"), 0.967345, 1e-4);
    EXPECT_NEAR(mean_of("edge_32.png", "edge_33.png"), 0.051732, 1e-4);
    EXPECT_EQ(mean_of("reference.png", "reference.png"), 0.0);
}

TEST(FlipLdr, IdenticalIsZero) {
    const Image a = noise(37, 41, 1);
    for (const float value : flip_ldr(a, a).pixels) EXPECT_EQ(value, 0.0f);
}

// Without features, by hand: HyAB(black, white) = 100 and the largest difference, of green and blue, is 203.3 before
// the exponent: 0.95 + 0.05 (100^0.7 - 0.4 c) / (0.6 c), c = 203.3^0.7.
TEST(FlipLdr, BlackOnWhite) {
    const Image map = flip_ldr(filled(30, 20, glm::vec3(0.0f)), filled(30, 20, glm::vec3(1.0f)));
    const double largest = std::pow(203.3, 0.7);
    const double expected = 0.95 + 0.05 * (std::pow(100.0, 0.7) - 0.4 * largest) / (0.6 * largest);
    for (const float value : map.pixels) EXPECT_NEAR(value, expected, 1e-4);
}

// Below the knee: L* of the linear value 0.2 is 51.837, of 0.21 it is 52.949.
TEST(FlipLdr, GreysBelowTheKnee) {
    const Image map = flip_ldr(filled(9, 9, glm::vec3(srgb(0.2f))), filled(9, 9, glm::vec3(srgb(0.21f))));
    const double difference = 116.0 * (std::cbrt(0.21) - std::cbrt(0.2));
    const double expected = 0.95 / 0.4 * std::pow(difference / 203.3, 0.7);
    for (const float value : map.pixels) EXPECT_NEAR(value, expected, 1e-4);
}

TEST(FlipLdr, GreenOnBlueIsTheLargest) {
    const Image green = filled(5, 5, {0, 1, 0}), blue = filled(5, 5, {0, 0, 1});
    for (const float value : flip_ldr(green, blue).pixels) EXPECT_NEAR(value, 1.0f, 1e-5f);
}

TEST(FlipLdr, SymmetricAndBounded) {
    const Image a = noise(50, 70, 1), b = noise(50, 70, 2);
    const Image ab = flip_ldr(a, b);
    EXPECT_EQ(ab.pixels, flip_ldr(b, a).pixels);
    EXPECT_GT(*std::min_element(ab.pixels.begin(), ab.pixels.end()), 0.0f);
    EXPECT_LE(*std::max_element(ab.pixels.begin(), ab.pixels.end()), 1.0f);
}

// Rows and columns are filtered by different code, in bands.
TEST(FlipLdr, RowsAndColumnsAlike) {
    const Image a = noise(33, 300, 1), b = noise(33, 300, 2);
    EXPECT_LT(largest_difference(transposed(flip_ldr(a, b)), flip_ldr(transposed(a), transposed(b))), 1e-5f);
}

TEST(FlipLdr, MirroredImagesMirrorTheMap) {
    Image a = noise(45, 20, 1), b = noise(45, 20, 2);
    const Image map = flip_ldr(a, b);
    const auto mirror = [](const Image& image) {
        Image result = image;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                std::copy_n(image.at(image.width - 1 - x, y), image.channels, result.at(x, y));
        return result;
    };
    EXPECT_LT(largest_difference(mirror(map), flip_ldr(mirror(a), mirror(b))), 1e-5f);
}

// Seen from farther away, fine noise melts into grey.
TEST(FlipLdr, DistanceHidesDetail) {
    const Image a = noise(64, 64, 1), b = noise(64, 64, 2);
    double last = 1.0;
    for (const double pixels_per_degree : {10.0, 30.0, 67.0, 150.0}) {
        const double now = mean(flip_ldr(a, b, pixels_per_degree));
        EXPECT_LT(now, last) << pixels_per_degree;
        last = now;
    }
}

// An edge that is missing is seen more than the same colours would be without one.
TEST(FlipLdr, FeaturesAmplify) {
    Image edge = filled(65, 65, glm::vec3(0.5f));
    for (int y = 0; y < 65; ++y)
        for (int x = 33; x < 65; ++x) std::fill_n(edge.at(x, y), 3, 0.55f);
    const Image map = flip_ldr(edge, filled(65, 65, glm::vec3(0.5f)));
    // At the edge itself the colour differs by half as much as far right of it.
    EXPECT_GT(*map.at(34, 32), 1.3f * *map.at(64, 32));
    EXPECT_EQ(*map.at(0, 32), 0.0f);
}

TEST(FlipLdr, SmallerThanTheFilters) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 40}, {40, 1}, {3, 2}}) {
        const Image map =
            flip_ldr(filled(width, height, glm::vec3(0.0f)), filled(width, height, glm::vec3(1.0f)), 1000.0);
        ASSERT_EQ(map.pixels.size(), std::size_t(width * height));
        for (const float value : map.pixels) EXPECT_NEAR(value, 0.96738f, 1e-4f);
    }
}

TEST(FlipLdr, LargestViewingAngle) {
    const Image map = flip_ldr(noise(20, 20, 1), noise(20, 20, 2), 1.0);
    for (const float value : map.pixels) EXPECT_TRUE(value >= 0.0f && value <= 1.0f) << value;
}

TEST(FlipLdr, OutOfRangeIsClipped) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    const Image clean = noise(20, 20, 1);
    Image wild = clean, clipped = clean;
    const float values[][2] = {{kNan, 0.0f}, {kInf, 1.0f}, {-kInf, 0.0f}, {7.0f, 1.0f}, {-3.0f, 0.0f}};
    for (std::size_t i = 0; i < std::size(values); ++i) {
        wild.pixels[200 + i] = values[i][0];
        clipped.pixels[200 + i] = values[i][1];
    }
    EXPECT_EQ(flip_ldr(wild, clean).pixels, flip_ldr(clipped, clean).pixels);
    EXPECT_EQ(flip_ldr(clean, wild).pixels, flip_ldr(clean, clipped).pixels);
}

TEST(FlipLdr, RefusesWhatItCannotCompare) {
    const Image image = filled(4, 3, glm::vec3(0.5f));
    EXPECT_NE(error_of(image, filled(3, 4, glm::vec3(0.5f))).find("4 x 3"), std::string::npos);
    EXPECT_NE(error_of(image, filled(5, 3, glm::vec3(0.5f))).find("5 x 3"), std::string::npos);
    EXPECT_NE(error_of(image, filled(4, 4, glm::vec3(0.5f))).find("4 x 4"), std::string::npos);
    EXPECT_NE(error_of(image, Image(4, 3, 4)).find("4 channels"), std::string::npos);
    EXPECT_NE(error_of(Image(4, 3, 1), Image(4, 3, 1)).find("RGB"), std::string::npos);
    EXPECT_NE(error_of(Image(0, 0, 3), Image(0, 0, 3)), "");
    for (const double pixels_per_degree :
         {0.0, 0.5, -67.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
        EXPECT_NE(error_of(image, image, pixels_per_degree), "") << pixels_per_degree;
}

TEST(FlipHdr, OneExposureIsLdrOfTheToneMapped) {
    const Image a = scaled(noise(30, 30, 1), 4.0f), b = scaled(noise(30, 30, 2), 4.0f);
    const Image hdr = flip_hdr(a, b, {.start = -1.5, .stop = 9.0, .count = 1});
    EXPECT_LT(largest_difference(hdr, flip_ldr(tone_mapped(a, -1.5), tone_mapped(b, -1.5))), 1e-4f);
}

TEST(FlipHdr, GreatestOverEvenlySpacedExposures) {
    const Image a = scaled(noise(30, 30, 1), 4.0f), b = scaled(noise(30, 30, 2), 4.0f);
    Image greatest(30, 30, 1);
    for (const double exposure : {-4.0, -1.5, 1.0}) {
        const Image map = flip_hdr(a, b, {.start = exposure, .stop = exposure, .count = 1});
        for (std::size_t i = 0; i < map.pixels.size(); ++i)
            greatest.pixels[i] = std::max(greatest.pixels[i], map.pixels[i]);
    }
    const Image all = flip_hdr(a, b, {.start = -4.0, .stop = 1.0, .count = 3});
    EXPECT_EQ(all.pixels, greatest.pixels);
}

// (0.6 x)(2.51 (0.6 x) + 0.03) = 0.85 ((0.6 x)(2.43 (0.6 x) + 0.59) + 0.14) at x = 1.4497: the brightest pixel is to
// be shown as 0.85 at the first exposure, the median one at the last.
TEST(FlipHdr, ExposureRange) {
    Image image = filled(5, 1, glm::vec3(1.0f));
    std::fill_n(image.at(0, 0), 3, 64.0f);
    std::fill_n(image.at(3, 0), 3, 0.1f);
    std::fill_n(image.at(4, 0), 3, 0.0f);
    const FlipExposures exposures = flip_exposures(image);
    const auto shown = [](double x) {
        x *= 0.6;
        return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    };
    EXPECT_NEAR(shown(64.0 * std::exp2(exposures.start)), 0.85, 1e-5);
    EXPECT_NEAR(shown(1.0 * std::exp2(exposures.stop)), 0.85, 1e-5);
    EXPECT_EQ(exposures.count, 6);
    EXPECT_EQ(flip_exposures(filled(3, 3, glm::vec3(2.0f))).count, 2);
}

TEST(FlipHdr, ExposuresFollowTheScale) {
    const Image image = noise(20, 20, 1);
    const FlipExposures dim = flip_exposures(scaled(image, std::exp2(-20.0f))), bright = flip_exposures(image);
    EXPECT_NEAR(dim.start, bright.start + 20.0, 1e-4);
    EXPECT_NEAR(dim.stop, bright.stop + 20.0, 1e-4);
    EXPECT_EQ(dim.count, bright.count);
}

// Pictures far beyond what a display shows are compared as well as any.
TEST(FlipHdr, ScaleMakesNoDifference) {
    const Image a = noise(30, 30, 1), b = noise(30, 30, 2);
    const double near_one = mean(flip_hdr(a, b, flip_exposures(a)));
    for (const float factor : {1e-6f, 1e6f}) {
        const Image scaled_a = scaled(a, factor);
        EXPECT_NEAR(mean(flip_hdr(scaled_a, scaled(b, factor), flip_exposures(scaled_a))), near_one, 1e-4);
    }
    EXPECT_LT(mean(flip_ldr(scaled(a, 1e6f), scaled(b, 1e6f))), 1e-4);  // all white
}

TEST(FlipHdr, MostlyBlackReference) {
    Image image = filled(9, 1, glm::vec3(0.0f));
    std::fill_n(image.at(0, 0), 3, 8.0f);
    std::fill_n(image.at(1, 0), 3, 2.0f);
    std::fill_n(image.at(2, 0), 3, 1.0f);
    const FlipExposures exposures = flip_exposures(image);
    EXPECT_NEAR(exposures.stop - exposures.start, 2.0, 1e-5);  // 8 and the median 2 of those that are not black

    const FlipExposures of_black = flip_exposures(filled(3, 3, glm::vec3(0.0f)));
    EXPECT_EQ(of_black.start, 0.0);
    EXPECT_EQ(of_black.stop, 0.0);
    EXPECT_GE(of_black.count, 1);
}

TEST(FlipHdr, NotFinite) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    const Image clean = scaled(noise(20, 20, 1), 3.0f);
    Image wild = clean, clipped = clean;
    const float values[][2] = {{kNan, 0.0f}, {kInf, 1e8f}, {-kInf, 0.0f}, {-3.0f, 0.0f}};
    for (std::size_t i = 0; i < std::size(values); ++i) {
        wild.pixels[200 + 3 * i] = values[i][0];
        clipped.pixels[200 + 3 * i] = values[i][1];
    }
    const FlipExposures exposures = flip_exposures(wild);
    EXPECT_TRUE(std::isfinite(exposures.start) && std::isfinite(exposures.stop));
    EXPECT_EQ(flip_hdr(clean, wild, exposures).pixels, flip_hdr(clean, clipped, exposures).pixels);
}

TEST(FlipHdr, RefusesNoExposures) {
    const Image image = filled(4, 3, glm::vec3(0.5f));
    constexpr double kInf = std::numeric_limits<double>::infinity();
    for (const FlipExposures& exposures :
         {FlipExposures{0.0, 1.0, 0}, FlipExposures{-kInf, 1.0, 2}, FlipExposures{0.0, kInf, 2}})
        EXPECT_THROW(flip_hdr(image, image, exposures), Error);
    EXPECT_THROW(flip_hdr(image, Image(4, 3, 1), {}), Error);
    EXPECT_THROW(flip_exposures(Image(4, 3, 1)), Error);
}

}  // namespace
}  // namespace pellucid
