// The tone map that adapts, against its formulas: Krawczyk et al. 2005.
#include "gpu/gpu_test.h"

#include <limits>

namespace pellucid::test {
namespace {

double key_of(double cd_m2) { return 1.03 - 2.0 / (2.0 + std::log10(cd_m2 + 1.0)); }
double rods(double cd_m2) { return 0.04 / (0.04 + cd_m2); }
double time_constant(double cd_m2) { return 0.1 + (0.4 - 0.1) * rods(cd_m2); }
double srgb(double linear) {
    linear = std::clamp(linear, 0.0, 1.0);
    return linear > 0.0031308 ? 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055 : 12.92 * linear;
}
/// What a grey of `cd_m2` looks like to an eye that has adapted to `adapted`.
glm::dvec3 shown(double cd_m2, double adapted, double exposure = 1.0) {
    const double relative = exposure * key_of(adapted) * cd_m2 / adapted, luminance = relative / (1.0 + relative);
    const glm::dvec3 c = luminance * glm::mix(glm::dvec3(1.0), glm::dvec3(1.05, 0.97, 1.27), rods(cd_m2));
    return {srgb(c.r), srgb(c.g), srgb(c.b)};
}

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr double kDarkest = 1e-4;  // added to every pixel before the mean

class Adapting : public RendererTest {
protected:
    /// A picture of nothing but an even grey.
    RenderResult see(double cd_m2, float seconds = kInfinite) {
        renderer().set_environment(uniform_environment(glm::vec3(float(cd_m2 / settings.unit_luminance_cd_m2))));
        settings.adaptation_s = seconds;
        return renderer().render(settings);
    }
    void expect_shown(const RenderResult& result, const glm::dvec3& expected) {
        for (int c = 0; c < 3; ++c)  // rounding to 8 bits, and a little for the device's power function
            EXPECT_NEAR(double(rgb(result.display, 3, 2)[c]), expected[c], 0.6 / 255.0) << c;
    }
    RenderSettings settings = [] {
        RenderSettings s;
        s.width = 70;  // not a multiple of a tile or a group
        s.height = 9;
        s.tonemap = ToneMap::kKrawczyk;
        return s;
    }();
};

TEST_F(Adapting, EvenPictureIsShownByTheFormula) {
    for (const double cd_m2 : {0.001, 0.03, 1.0, 50.0, 3000.0, 1e6}) {
        SCOPED_TRACE(cd_m2);
        const RenderResult result = see(cd_m2);
        EXPECT_NEAR(double(result.adapted_cd_m2) / (cd_m2 + kDarkest), 1.0, 1e-4);
        expect_shown(result, shown(cd_m2, cd_m2 + kDarkest));
    }
}

TEST_F(Adapting, TwiceAsBrightIsShownByTheFormulaAtOnceAndOnceAdaptedTo) {
    see(40.0);
    expect_shown(see(80.0, 0.0f), shown(80.0, 40.0));
    expect_shown(see(80.0, 1000.0f), shown(80.0, 80.0));
}

TEST_F(Adapting, AfterTheTimeConstantAllButOneOverEOfTheWayIsDone) {
    // Cones, rods, and from light to dark: the new picture says which time it takes.
    for (const auto& [before, after] : {std::pair(100.0, 900.0), std::pair(0.001, 0.003), std::pair(500.0, 0.02)}) {
        const double tau = time_constant(after + kDarkest), end = after + kDarkest;
        const double start = double(see(before).adapted_cd_m2);
        const double one = double(see(after, float(tau)).adapted_cd_m2);
        EXPECT_NEAR((one - start) / (end - start), 1.0 - std::exp(-1.0), 1e-3) << before << " to " << after;
        see(before);
        see(after, float(0.25 * tau));
        EXPECT_NEAR(double(see(after, float(0.75 * tau)).adapted_cd_m2) / one, 1.0, 1e-3);  // as in one step
    }
    EXPECT_GT(time_constant(0.003), 0.37);
}

TEST_F(Adapting, MeanIsThatOfTheLogarithmsOverAllPixels) {
    renderer().set_scene(load_scene("shape:torus"));
    settings.width = 203;
    settings.height = 131;
    const RenderResult result = renderer().render(settings);
    double sum = 0.0;
    for (int y = 0; y < int(settings.height); ++y) {
        for (int x = 0; x < int(settings.width); ++x) {
            const double luminance = glm::dot(glm::dvec3(rgb(result.radiance, x, y)), {0.2126, 0.7152, 0.0722});
            sum += std::log(luminance * double(settings.unit_luminance_cd_m2) + kDarkest);
        }
    }
    EXPECT_NEAR(double(result.adapted_cd_m2) / std::exp(sum / (203.0 * 131.0)), 1.0, 1e-4);
}

TEST_F(Adapting, BlackIsBlack) {
    for (const double before : {-1.0, 100.0}) {  // with and without anything seen before
        if (before > 0.0) see(before);
        const RenderResult result = see(0.0);
        EXPECT_TRUE(std::isfinite(result.adapted_cd_m2));
        EXPECT_TRUE(all_finite(result.display));
        EXPECT_EQ(rgb(result.display, 3, 2), glm::vec3(0.0f));
    }
    expect_shown(see(100.0), shown(100.0, 100.0));
}

TEST_F(Adapting, FirstPictureIsAdaptedTo) { expect_shown(see(250.0, 0.0f), shown(250.0, 250.0)); }

TEST_F(Adapting, OtherPicturesInBetweenAreNotSeen) {
    see(10.0);
    settings.tonemap = ToneMap::kNeutral;
    EXPECT_EQ(see(1e4).adapted_cd_m2, 0.0f);
    see(1e4);
    settings.tonemap = ToneMap::kKrawczyk;
    EXPECT_NEAR(see(1e4, 0.0f).adapted_cd_m2, 10.0f, 0.01f);
}

TEST_F(Adapting, ExposureGoesOnTop) {
    settings.exposure_ev = 1.0f;
    const RenderResult result = see(50.0);
    EXPECT_NEAR(result.adapted_cd_m2, 50.0f, 0.01f);
    expect_shown(result, shown(50.0, 50.0, 2.0));
}

TEST_F(Adapting, SamplesAndUnitsDoNotMatter) {
    settings.samples = 3;
    settings.unit_luminance_cd_m2 = 1.0f;
    expect_shown(see(20.0), shown(20.0, 20.0));
}

TEST_F(Adapting, ColoursFadeInTheDark) {
    const auto red_share = [&](float radiance) {
        renderer().set_environment(uniform_environment({radiance, 0.1f * radiance, 0.1f * radiance}));
        const glm::vec3 c = rgb(renderer().render(settings).display, 3, 2);
        return c.r / c.b;
    };
    EXPECT_GT(red_share(1.0f), 1.5f);   // 20 cd/m2
    EXPECT_LT(red_share(1e-6f), 1.0f);  // rods see alone: bluish
}

TEST_F(Adapting, NonsenseIsRefused) {
    const auto refused = [&](float unit, float seconds) {
        settings.unit_luminance_cd_m2 = unit;
        settings.adaptation_s = seconds;
        EXPECT_THROW(renderer().render(settings), Error) << unit << " " << seconds;
    };
    for (const float unit : {0.0f, -1.0f, kInfinite, std::nanf("")}) refused(unit, 0.0f);
    for (const float seconds : {-1.0f, std::nanf("")}) refused(1.0f, seconds);
}

}  // namespace
}  // namespace pellucid::test
