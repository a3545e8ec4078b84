// What the path tracer chooses directions by: its densities are those it says they are.
#include "reference/bsdf.h"
#include "reference/environment_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace pellucid::reference {
namespace {

using std::numbers::pi;

glm::dvec3 on_sphere(glm::dvec2 u) {
    const double z = 1.0 - 2.0 * u.x, radius = std::sqrt(std::max(1.0 - z * z, 0.0));
    return {radius * std::cos(2.0 * pi * u.y), z, radius * std::sin(2.0 * pi * u.y)};
}

/// A dark map with one bright texel, a dim one at the seam and one at a pole.
Environment sunny_map() {
    Environment environment;
    environment.kind = Environment::Kind::kMap;
    environment.map = Image(64, 32, 3);
    for (float& value : environment.map.pixels) value = 0.1f;
    environment.map.at(20, 8)[0] = 3e4f;
    environment.map.at(20, 8)[1] = 2e4f;
    environment.map.at(0, 20)[1] = 50.0f;
    environment.map.at(40, 0)[2] = 200.0f;
    return environment;
}

Environment named(const char* name) { return load_environment(name); }

Environment rotated(Environment environment, float rotation) {
    environment.rotation = rotation;
    return environment;
}

TEST(PathSampling, RandomNumbersAreUniformAndPathsDiffer) {
    constexpr int kBins = 16, kPaths = 4000;
    std::vector<int> firsts(kBins), seconds(kBins);
    for (int path = 0; path < kPaths; ++path) {
        Random random(1, std::uint64_t(path % 50), std::uint64_t(path / 50));
        ++firsts[std::size_t(random.next() * kBins)];
        ++seconds[std::size_t(random.next() * kBins)];
    }
    for (const auto& bins : {firsts, seconds}) {
        double chi2 = 0.0;
        for (const int count : bins) chi2 += std::pow(count - double(kPaths) / kBins, 2) * kBins / kPaths;
        EXPECT_LT(chi2, 38.0) << "99.9% of uniform samples of 15 degrees of freedom";
    }
    EXPECT_NE(Random(1, 2, 3).next(), Random(1, 3, 2).next());
    EXPECT_NE(Random(1, 2, 3).next(), Random(2, 1, 3).next());
    EXPECT_EQ(Random(7, 8, 9).next(), Random(7, 8, 9).next());
}

TEST(EnvironmentSampler, DensityIntegratesToOne) {
    for (const Environment& environment :
         {sunny_map(), named("studio"), named("sky"), named("uniform"), rotated(sunny_map(), -2.0f)}) {
        const EnvironmentSampler sampler(environment);
        constexpr int kWidth = 1536, kHeight = 768;
        double sum = 0.0;
        for (int y = 0; y < kHeight; ++y) {
            const double theta = (y + 0.5) * pi / kHeight;
            for (int x = 0; x < kWidth; ++x) {
                const double phi = (x + 0.5) * 2.0 * pi / kWidth;
                sum +=
                    sampler.pdf({std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)}) *
                    std::sin(theta);
            }
        }
        EXPECT_NEAR(sum * (pi / kHeight) * (2.0 * pi / kWidth), 1.0, 2e-3);
    }
}

TEST(EnvironmentSampler, ChoosesWithTheDensityThatItStates) {
    for (const Environment& environment :
         {sunny_map(), named("sky"), rotated(sunny_map(), 2.5f), rotated(named("sky"), -9.0f)}) {
        const EnvironmentSampler sampler(environment);
        constexpr int kColumns = 16, kRows = 8, kSamples = 40000, kFine = 32;
        const auto bin_of = [](const glm::dvec3& d) {
            const double u = std::min(0.5 + std::atan2(d.z, d.x) / (2.0 * pi), 1.0 - 1e-12);
            const double v = std::min(std::acos(d.y) / pi, 1.0 - 1e-12);
            return std::size_t(v * kRows) * kColumns + std::size_t(u * kColumns);
        };
        std::vector<double> expected(kColumns * kRows), found(kColumns * kRows);
        for (int y = 0; y < kRows * kFine; ++y) {
            const double theta = (y + 0.5) * pi / (kRows * kFine);
            for (int x = 0; x < kColumns * kFine; ++x) {
                const double phi = ((x + 0.5) / (kColumns * kFine) - 0.5) * 2.0 * pi;
                const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
                expected[bin_of(d)] += kSamples * sampler.pdf(d) * std::sin(theta) * (pi / (kRows * kFine)) *
                                       (2.0 * pi / (kColumns * kFine));
            }
        }
        Random random(3, 0, 0);
        for (int i = 0; i < kSamples; ++i) {
            const EnvironmentSampler::Sample sample = sampler.sample(random);
            EXPECT_NEAR(glm::length(sample.direction), 1.0, 1e-9);
            ASSERT_GT(sample.pdf, 0.0);
            ++found[bin_of(sample.direction)];
        }
        double chi2 = 0.0;
        int bins = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            if (expected[i] < 5.0) continue;
            chi2 += (found[i] - expected[i]) * (found[i] - expected[i]) / expected[i];
            ++bins;
        }
        EXPECT_LT(chi2, bins + 4.0 * std::sqrt(2.0 * bins)) << bins << " bins";
        EXPECT_GT(bins, 1);
    }
}

TEST(EnvironmentSampler, StatesTheDensityOfWhatItChose) {
    for (const float rotation : {0.0f, 3.0f, -4.0f}) {
        const EnvironmentSampler sampler(rotated(sunny_map(), rotation));
        Random random(5, 0, 0);
        int different = 0;
        for (int i = 0; i < 10000; ++i) {
            const EnvironmentSampler::Sample sample = sampler.sample(random);
            different += std::abs(sampler.pdf(sample.direction) / sample.pdf - 1.0) > 1e-9;
        }
        EXPECT_LE(different, 2) << "rounding on the border of two cells";
    }
}

// The bright texel of the map, and the sun with a twentieth of the sky's light, are where radiance() shows it.
TEST(EnvironmentSampler, ChoosesWhereARotatedEnvironmentIsBright) {
    for (Environment environment : {sunny_map(), named("sky")}) {
        environment.rotation = 1.9f;
        environment.intensity = 0.5f;
        const EnvironmentSampler sampler(environment);
        Random random(11, 0, 0);
        int bright = 0;
        for (int i = 0; i < 2000; ++i)
            bright += radiance(environment, glm::vec3(sampler.sample(random).direction)).r > 10.0f ? 1 : 0;
        EXPECT_GT(bright, environment.kind == Environment::Kind::kMap ? 1200 : 80);
    }
}

TEST(EnvironmentSampler, CoversAllLightOfABilinearMap) {
    // Where the map shows light, even the last of a bright texel's slope, it can be chosen.
    const Environment environment = sunny_map();
    const EnvironmentSampler sampler(environment);
    Random random(9, 0, 0);
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 d = on_sphere(random.next2());
        EXPECT_GT(sampler.pdf(d), 0.0);
    }
}

TEST(EnvironmentSampler, DarknessIsKnown) {
    Environment environment;
    environment.kind = Environment::Kind::kUniform;
    environment.uniform_radiance = glm::vec3(0.0f);
    Environment out = sunny_map();
    out.intensity = 0.0f;
    for (const Environment& dark : {environment, out}) {
        const EnvironmentSampler sampler(dark);
        EXPECT_TRUE(sampler.dark());
        EXPECT_EQ(sampler.pdf({0, 1, 0}), 0.0);
    }
}

struct NamedBsdf {
    const char* name;
    Bsdf bsdf;
};
std::vector<NamedBsdf> rough_bsdfs() {
    const glm::dvec3 white(1.0), colour(0.9, 0.5, 0.1);
    return {{"matt", OpaqueBsdf(white, 0.0, 1.0, 1.0)},
            {"coated", OpaqueBsdf(colour, 0.0, 0.5, 1.5)},
            {"metal", OpaqueBsdf(colour, 1.0, 0.4, 1.5)},
            {"half metal", OpaqueBsdf(colour, 0.5, 1.0, 1.5)},
            {"into glass", InterfaceBsdf(1.0, 1.5, 0.5, white)},
            {"out of glass", InterfaceBsdf(1.5, 1.0, 0.6, white)},
            {"into diamond", InterfaceBsdf(1.0, 2.4, 1.0, colour)},
            {"pane", PaneBsdf(1.5, 0.5, colour)}};
}

BsdfValue value_of(const Bsdf& bsdf, const glm::dvec3& wo, const glm::dvec3& wi, Random& random) {
    return std::visit([&](const auto& b) { return b.evaluate(wo, wi, random); }, bsdf);
}
std::optional<BsdfSample> sample_of(const Bsdf& bsdf, const glm::dvec3& wo, Random& random) {
    return std::visit([&](const auto& b) { return b.sample(wo, random); }, bsdf);
}

/// Mean of `f` and its standard error.
struct Estimate {
    double mean = 0.0, error = 0.0;
};
Estimate estimate(int samples, const std::function<double()>& f) {
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < samples; ++i) {
        const double value = f();
        sum += value;
        squares += value * value;
    }
    const double mean = sum / samples;
    return {mean, std::sqrt(std::max(squares / samples - mean * mean, 0.0) / (samples - 1))};
}

void expect_agree(const Estimate& a, const Estimate& b) {
    EXPECT_NEAR(a.mean, b.mean, 4.0 * std::hypot(a.error, b.error) + 1e-9);
}

/// Any function of the direction will do. This one tells sides and azimuths apart.
double probe(const glm::dvec3& w) { return 1.0 + 0.5 * w.x + (w.z > 0.0 ? 0.3 : 0.0) * w.y * w.y; }

TEST(Bsdf, OpaqueSurfacesSampleWithTheDensityThatTheyState) {
    // Any function of the sampled direction has the mean that the density gives it. A direction that is not
    // chosen (light that the next facet would catch) has none.
    for (const NamedBsdf& named : rough_bsdfs()) {
        if (!std::holds_alternative<OpaqueBsdf>(named.bsdf)) continue;
        for (const double cos_o : {0.95, 0.4}) {
            SCOPED_TRACE(testing::Message() << named.name << " at cosine " << cos_o);
            const glm::dvec3 wo(std::sqrt(1.0 - cos_o * cos_o), 0.0, cos_o);
            Random random(11, 0, 0);
            const Estimate sampled = estimate(200000, [&] {
                const auto sample = sample_of(named.bsdf, wo, random);
                return sample ? probe(sample->wi) : 0.0;
            });
            const Estimate integrated = estimate(800000, [&] {
                const glm::dvec3 d = on_sphere(random.next2());
                return 4.0 * pi * value_of(named.bsdf, wo, d, random).pdf * probe(d);
            });
            expect_agree(sampled, integrated);
        }
    }
}

TEST(Bsdf, SampledWeightsAreTheIntegralOfTheValue) {
    // Weighted by any function of the direction, samples have the mean that the BSDF gives it.
    for (const NamedBsdf& named : rough_bsdfs()) {
        for (const double cos_o : {0.95, 0.8, 0.4}) {
            SCOPED_TRACE(testing::Message() << named.name << " at cosine " << cos_o);
            const glm::dvec3 wo(std::sqrt(1.0 - cos_o * cos_o), 0.0, cos_o);
            Random random(12, 0, 0);
            const Estimate sampled = estimate(100000, [&] {
                const auto sample = sample_of(named.bsdf, wo, random);
                return sample ? sample->weight.g * probe(sample->wi) : 0.0;
            });
            const Estimate integrated = estimate(300000, [&] {
                const glm::dvec3 d = on_sphere(random.next2());
                return 4.0 * pi * value_of(named.bsdf, wo, d, random).value.g * probe(d);
            });
            expect_agree(sampled, integrated);
        }
    }
}

TEST(Bsdf, NoSurfaceMakesLight) {
    for (const NamedBsdf& named : rough_bsdfs()) {
        SCOPED_TRACE(named.name);
        const glm::dvec3 wo(0.6, 0.0, 0.8);
        Random random(12, 0, 0);
        const Estimate sampled = estimate(100000, [&] {
            const auto sample = sample_of(named.bsdf, wo, random);
            return sample ? sample->weight.r : 0.0;
        });
        EXPECT_LE(sampled.mean, 1.0 + 4.0 * sampled.error + 1e-12);
    }
}

TEST(Bsdf, SampleAndEvaluateStateTheSamePositiveDensity) {
    // The weights of multiple importance sampling add up to 1 only then.
    for (const NamedBsdf& named : rough_bsdfs()) {
        SCOPED_TRACE(named.name);
        Random random(15, 0, 0);
        for (int i = 0; i < 2000; ++i) {
            glm::dvec3 wo = on_sphere(random.next2());
            wo.z = std::abs(wo.z);
            const auto sample = sample_of(named.bsdf, wo, random);
            if (!sample) continue;
            EXPECT_GT(sample->pdf, 0.0);
            EXPECT_NEAR(value_of(named.bsdf, wo, sample->wi, random).pdf, sample->pdf, 1e-9 * sample->pdf);
        }
    }
}

TEST(Bsdf, IsReciprocal) {
    Random random(13, 0, 0);
    for (const NamedBsdf& named : rough_bsdfs()) {
        if (!std::holds_alternative<OpaqueBsdf>(named.bsdf)) continue;
        SCOPED_TRACE(named.name);
        for (int i = 0; i < 100; ++i) {
            glm::dvec3 a = on_sphere(random.next2()), b = on_sphere(random.next2());
            a.z = std::abs(a.z) + 1e-3, b.z = std::abs(b.z) + 1e-3;
            a = glm::normalize(a), b = glm::normalize(b);
            const double there = value_of(named.bsdf, a, b, random).value.r / b.z,
                         back = value_of(named.bsdf, b, a, random).value.r / a.z;
            EXPECT_NEAR(there, back, 1e-9 * (there + back));
        }
    }
    // Basic radiance goes through a boundary the same way in both directions; each side has its own frame. One
    // facet alone: test_rough_glass.cpp has several.
    const Microfacets facets{0.25};
    const RoughInterface in(facets, 1.0, 1.5), out(facets, 1.5, 1.0);
    const glm::dvec3 air = glm::normalize(glm::dvec3(0.5, 0.2, 0.8)),
                     glass = glm::normalize(glm::dvec3(-0.3, 0.1, -0.9));
    const auto flipped = [](const glm::dvec3& w) { return glm::dvec3(w.x, w.y, -w.z); };
    const double there = in.single(air, glass) / std::abs(glass.z);
    const double back = out.single(flipped(glass), flipped(air)) / air.z;
    EXPECT_GT(there, 0.0);
    EXPECT_NEAR(there / (1.5 * 1.5), back, 1e-9 * there) << "Walter 2007, f(i, o) / n_o^2 = f(o, i) / n_i^2";
}

TEST(Bsdf, SmoothSurfacesAreMirrors) {
    Random random(14, 0, 0);
    const glm::dvec3 wo(0.6, 0.0, 0.8);
    const InterfaceBsdf glass(1.0, 1.5, 0.0, glm::dvec3(1.0));
    EXPECT_TRUE(glass.only_mirrors());
    EXPECT_EQ(glass.evaluate(wo, {-0.6, 0.0, 0.8}, random).pdf, 0.0);
    for (int i = 0; i < 100; ++i) {
        const auto sample = glass.sample(wo, random);
        ASSERT_TRUE(sample && sample->mirror);
        EXPECT_EQ(sample->weight, glm::dvec3(1.0));
        EXPECT_NEAR(sample->wi.x, sample->wi.z > 0.0 ? -0.6 : -0.4, 1e-12);
    }
    const InterfaceBsdf nothing(1.5, 1.5, 0.7, glm::dvec3(1.0));
    const auto straight = nothing.sample(wo, random);
    ASSERT_TRUE(straight && straight->mirror);
    EXPECT_LT(glm::distance(straight->wi, -wo), 1e-12) << "equal media: no boundary, however rough";
}

}  // namespace
}  // namespace pellucid::reference
