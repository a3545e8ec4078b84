// Pictures whose pixels take as many samples as their noise asks for.
#include "gpu/gpu_test.h"
#include "unit/built_scenes.h"

#include "render/adaptive_sampling.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

namespace pellucid::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

RenderSettings settings_of(const std::string& technique) {
    RenderSettings settings;
    settings.width = 64;
    settings.height = 48;
    settings.technique = technique;
    settings.error = 0.2f;
    settings.most_samples = 9;
    return settings;
}

/// Rough glass, which scatters by random numbers.
Scene rough_torus() {
    Scene scene = load_scene("shape:torus");
    scene.materials.front().roughness = 0.3f;
    return scene;
}

using AdaptivePicture = RendererTest;
class AdaptivePictures : public TechniqueTest {};

/// Each pixel is that of a picture with as many samples of every pixel.
TEST_P(AdaptivePictures, PixelsAreThoseOfPicturesWithTheirSamples) {
    renderer().set_scene(rough_torus());
    RenderSettings settings = settings_of(GetParam());
    const RenderResult adaptive = renderer().render(settings);
    const Image& counts = adaptive.sample_counts;
    ASSERT_EQ(counts.pixels.size(), std::size_t(settings.width) * settings.height);
    const std::set<float> present(counts.pixels.begin(), counts.pixels.end());
    ASSERT_GE(present.size(), 3u);  // or nothing is shown
    EXPECT_EQ(*present.begin(), float(kFewestSamples));
    settings.error = 0.0f;
    for (const float count : present) {
        settings.samples = std::uint32_t(count);
        const RenderResult uniform = renderer().render(settings);
        for (std::size_t i = 0; i < counts.pixels.size(); ++i) {
            if (counts.pixels[i] != count) continue;
            for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
                const float value = uniform.radiance.pixels[c];
                ASSERT_NEAR(adaptive.radiance.pixels[c], value, 1e-5f * (1.0f + value)) << "pixel " << i;  // rounding
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Techniques, AdaptivePictures,
                         ::testing::Values("visibility-layers", "ray-tracing-cpu", "wang-2014", "path"),
                         technique_test_name);

TEST_F(AdaptivePicture, TheErrorIsWhatWasAsked) {
    renderer().set_scene(rough_torus());
    RenderSettings settings = settings_of("path");
    settings.error = 0.1f;
    settings.most_samples = 4096;
    const RenderResult adaptive = renderer().render(settings);
    settings.error = 0.0f;
    settings.samples = 4096;
    settings.parameters["seed"] = 2;
    const RenderResult truth = renderer().render(settings);
    double squares = 0.0, bias = 0.0;
    const std::size_t pixels = truth.radiance.pixels.size() / 3;
    for (std::size_t i = 0; i < pixels; ++i) {
        const float *a = &adaptive.radiance.pixels[3 * i], *b = &truth.radiance.pixels[3 * i];
        const double grey = 0.18 + 0.2126 * double(b[0]) + 0.7152 * double(b[1]) + 0.0722 * double(b[2]);
        const double difference = double(a[1] - b[1]) / grey;
        squares += difference * difference / double(pixels);
        bias += difference / double(pixels);
    }
    // Eight samples tell a variance to a factor of two or so; most pixels are smooth, and below what they may have.
    EXPECT_LT(std::sqrt(squares), 0.1);
    EXPECT_LT(std::abs(bias), 3.0 * std::sqrt(squares / double(pixels)));
}

TEST_F(AdaptivePicture, SaysWhereTheMostSamplesDoNotDo) {
    renderer().set_scene(rough_torus());
    RenderSettings settings = settings_of("visibility-layers");
    settings.error = 1e-4f;
    EXPECT_THAT(renderer().render(settings).warnings, Contains(HasSubstr("pixels have 9 samples, the most")));
    settings.error = -1.0f;
    EXPECT_THROW(renderer().render(settings), Error);
    settings.error = 0.1f;
    settings.most_samples = 0;
    EXPECT_THROW(renderer().render(settings), Error);
}

}  // namespace
}  // namespace pellucid::test
