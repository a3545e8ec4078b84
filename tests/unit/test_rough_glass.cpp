// Rough glass with all reflections and refractions between its facets: it loses no light, is reciprocal, and
// scatters as rays do that are followed from facet to facet.
#include "reference/bsdf.h"
#include "reference/rough_interface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace pellucid::reference {
namespace {

using std::numbers::pi;

constexpr double kRoughnesses[] = {0.0, 0.2, 0.4, 0.6, 0.8, 1.0};
const glm::dvec3 kWhite(1.0);

glm::dvec3 at_angles(double cos_theta, double phi) {
    const double sine = std::sqrt(std::max(1.0 - cos_theta * cos_theta, 0.0));
    return {sine * std::cos(phi), sine * std::sin(phi), cos_theta};
}
glm::dvec3 on_sphere(glm::dvec2 u) { return at_angles(1.0 - 2.0 * u.x, 2.0 * pi * u.y); }
/// A direction to the viewer, uniform over the disc that a sphere shows.
glm::dvec3 on_disc(glm::dvec2 u) { return at_angles(std::sqrt(1.0 - u.x), 2.0 * pi * u.y); }
glm::dvec3 flipped(const glm::dvec3& w) { return {w.x, w.y, -w.z}; }
RoughInterface rough_interface(double n_o, double n_i, double roughness) {
    return {Microfacets{roughness * roughness}, n_o, n_i};
}

/// Mean and standard error of what is added.
class Mean {
public:
    void add(double value) {
        ++count_;
        sum_ += value;
        squares_ += value * value;
    }
    double mean() const { return sum_ / count_; }
    double error() const { return std::sqrt(std::max(squares_ / count_ - mean() * mean(), 0.0) / (count_ - 1.0)); }

private:
    double count_ = 0.0, sum_ = 0.0, squares_ = 0.0;
};

/// Weight of a direction chosen with density `pdf` that `other` might have chosen: the power heuristic.
double power_heuristic(double pdf, double other) { return pdf * pdf / (pdf * pdf + other * other); }

/// Light that comes from a uniform environment of radiance 1, sampled as PathWalk does.
template <class AnyBsdf>
double furnace(const AnyBsdf& bsdf, const glm::dvec3& wo, Random& random) {
    constexpr double kUniform = 0.25 / pi;
    double light = 0.0;
    if (!bsdf.only_mirrors()) {
        const BsdfValue value = bsdf.evaluate(wo, on_sphere(random.next2()), random);
        light += value.value.g / kUniform * power_heuristic(kUniform, value.pdf);
    }
    const auto sample = bsdf.sample(wo, random);
    if (!sample) return light;
    return light + sample->weight.g * (sample->mirror ? 1.0 : power_heuristic(sample->pdf, kUniform));
}

template <class AnyBsdf>
void expect_lossless(const AnyBsdf& bsdf, int samples) {
    Random random(21, 0, 0);
    Mean light;
    for (int i = 0; i < samples; ++i) light.add(furnace(bsdf, on_disc(random.next2()), random));
    EXPECT_LT(light.error(), 5e-4);
    EXPECT_NEAR(light.mean(), 1.0, 2e-3) << "at least four standard errors";
}

TEST(RoughGlass, LosesNoLightInTheFurnace) {
    for (const double index : {1.2, 1.5, 2.42}) {
        for (const double roughness : kRoughnesses) {
            SCOPED_TRACE(testing::Message() << "index " << index << ", roughness " << roughness);
            expect_lossless(InterfaceBsdf(1.0, index, roughness, kWhite), 200000);
            expect_lossless(InterfaceBsdf(index, 1.0, roughness, kWhite), 200000);
        }
    }
}

TEST(RoughGlass, PanesLoseNoLightInTheFurnace) {
    for (const double roughness : kRoughnesses) {
        SCOPED_TRACE(roughness);
        expect_lossless(PaneBsdf(1.5, roughness, kWhite), 200000);
    }
}

TEST(RoughGlass, TintsOnceWhatEndsOnTheOtherSide) {
    const InterfaceBsdf clear(1.0, 1.5, 0.9, kWhite), tinted(1.0, 1.5, 0.9, {0.5, 1.0, 0.0});
    Random random(22, 0, 0), same(22, 0, 0);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 wo = on_disc(random.next2()), wi = on_sphere(random.next2());
        same.next2(), same.next2();
        const BsdfValue a = clear.evaluate(wo, wi, random), b = tinted.evaluate(wo, wi, same);
        EXPECT_EQ(b.value, wi.z > 0.0 ? a.value : a.value * glm::dvec3(0.5, 1.0, 0.0));
        EXPECT_EQ(b.pdf, a.pdf);
        const auto sample = tinted.sample(wo, random);
        clear.sample(wo, same);
        ASSERT_TRUE(sample);
        EXPECT_EQ(sample->weight, sample->wi.z > 0.0 ? kWhite : glm::dvec3(0.5, 1.0, 0.0));
    }
}

/// How much light goes from one bin of directions to another, on the same side or through the surface. A bin is
/// one of 4 equal shares of cos^2 theta. The turn from wo to wi has 4 bins, too.
class Exchange {
public:
    static constexpr int kRings = 4, kTurns = 4;
    /// Counts samples of `surface` for viewers spread evenly over the disc.
    Exchange(const RoughInterface& surface, int samples, std::uint64_t seed) : counts_(2 * kRings * kRings * kTurns) {
        Random random(seed, 0, 0);
        for (int i = 0; i < samples; ++i) {
            const glm::dvec3 wo = on_disc(random.next2()), wi = surface.sample(wo, random);
            const double turn = std::abs(std::remainder(std::atan2(wi.y, wi.x) - std::atan2(wo.y, wo.x), 2.0 * pi));
            const int turned = std::min(int(turn / pi * kTurns), kTurns - 1);
            ++counts_[index(wi.z < 0.0, ring_of(wo), ring_of(wi), turned)];
        }
    }
    double count(bool through, int from, int to, int turn) const { return counts_[index(through, from, to, turn)]; }

private:
    static int ring_of(const glm::dvec3& w) { return std::min(int(w.z * w.z * kRings), kRings - 1); }
    static std::size_t index(bool through, int from, int to, int turn) {
        return std::size_t(((through ? kRings : 0) + from) * kRings * kTurns + to * kTurns + turn);
    }
    std::vector<double> counts_;
};

/// Compares counts with the counts of the reverse direction; `back` should be `ratio` times `there`.
class CountsAgree {
public:
    void add(double there, double back, double ratio) {
        const double variance = ratio * ratio * there + back;
        if (variance < 50.0) return;
        chi2_ += std::pow(ratio * there - back, 2) / variance;
        ++pairs_;
    }
    void expect(int pairs_at_least) const {
        EXPECT_GE(pairs_, pairs_at_least);
        EXPECT_LT(chi2_, pairs_ + 4.0 * std::sqrt(2.0 * pairs_)) << pairs_ << " pairs, four standard deviations";
    }

private:
    double chi2_ = 0.0;
    int pairs_ = 0;
};

TEST(RoughGlass, SamplesAreReciprocal) {
    // Viewers are spread by cos theta_o, so counts are in proportion to the BSDF and both cosines. For basic
    // radiance f(o, i) / n_i^2 = f(i, o) / n_o^2, which is f(o, i) = f(i, o) on one side.
    constexpr double kIndex = 1.5;
    constexpr int kSamples = 1000000;
    for (const double roughness : {0.5, 1.0}) {
        SCOPED_TRACE(roughness);
        const Exchange in(rough_interface(1.0, kIndex, roughness), kSamples, 25);
        const Exchange out(rough_interface(kIndex, 1.0, roughness), kSamples, 26);
        CountsAgree reflected, refracted;
        for (int a = 0; a < Exchange::kRings; ++a) {
            for (int b = 0; b < Exchange::kRings; ++b) {
                for (int turn = 0; turn < Exchange::kTurns; ++turn) {
                    refracted.add(in.count(true, a, b, turn), out.count(true, b, a, turn), 1.0 / (kIndex * kIndex));
                    if (b >= a) continue;
                    reflected.add(in.count(false, a, b, turn), in.count(false, b, a, turn), 1.0);
                    reflected.add(out.count(false, a, b, turn), out.count(false, b, a, turn), 1.0);
                }
            }
        }
        reflected.expect(40);
        refracted.expect(40);
    }
}

/// The BSDF of two or more facets.
Mean estimated_bsdf(const RoughInterface& surface, const glm::dvec3& wo, const glm::dvec3& wi) {
    Random random(23, 0, 0);
    Mean mean;
    for (int i = 0; i < 200000; ++i) mean.add(surface.multiple(wo, wi, random) / std::abs(wi.z));
    return mean;
}

void expect_same(const Mean& a, const Mean& b, double share_of_b) {
    const double error = std::hypot(a.error(), share_of_b * b.error());
    EXPECT_NEAR(a.mean(), share_of_b * b.mean(), 4.0 * error);
    EXPECT_LT(error, 0.02 * a.mean()) << "too noisy to tell anything";
}

TEST(RoughGlass, LightBetweenFacetsIsReciprocal) {
    constexpr double kIndex = 1.5;
    for (const double roughness : {0.6, 1.0}) {
        SCOPED_TRACE(roughness);
        const RoughInterface in = rough_interface(1.0, kIndex, roughness);
        const RoughInterface out = rough_interface(kIndex, 1.0, roughness);
        const glm::dvec3 a = at_angles(0.9, 0.3), b = at_angles(0.4, 2.5);
        for (const RoughInterface& side : {in, out}) {
            expect_same(estimated_bsdf(side, a, b), estimated_bsdf(side, b, a), 1.0);
        }
        // Each side has its own frame.
        for (const auto& [air, glass] : {std::pair(a, flipped(b)), std::pair(b, flipped(a))}) {
            expect_same(estimated_bsdf(in, air, glass), estimated_bsdf(out, flipped(glass), flipped(air)),
                        kIndex * kIndex);
        }
    }
}

/// Unpolarised reflectance of a facet; 1 under total reflection. Written apart from the code under test.
double facet_reflectance(double cos_here, double n_here, double n_there) {
    const double sine = n_here / n_there * std::sqrt(std::max(1.0 - cos_here * cos_here, 0.0));
    if (sine >= 1.0) return 1.0;
    const double cos_there = std::sqrt(1.0 - sine * sine);
    const double s = (n_here * cos_here - n_there * cos_there) / (n_here * cos_here + n_there * cos_there);
    const double p = (n_there * cos_here - n_here * cos_there) / (n_there * cos_here + n_here * cos_there);
    return 0.5 * (s * s + p * p);
}

/// Follows rays from facet to facet without any formula of Smith's: no masking, no visible normals.
///
/// The heights of the surface are uniform in -1..1. The surface over or under a ray has not been crossed yet, so
/// its height is uniform over the heights on the far side. At each of these heights lie facets of all normals, in
/// proportion to the area that a GGX surface has of them. A ray hence meets candidates at random (Woodcock
/// tracking), and hits one with probability |cos| of the angle to it, if the facet faces the ray.
class FacetSimulation {
public:
    FacetSimulation(double alpha, double n_above, double n_below) : n_above_(n_above), n_below_(n_below) {
        // Area of the facets up to each cosine, per macroscopic area. For GGX the slopes have the density
        // 1 / (pi alpha^2 (1 + tan^2 / alpha^2)^2), and area is 1 / cos of its projection.
        double sum = 0.0;
        for (int i = 0; i < kTable; ++i) {
            const double c = (i + 0.5) / kTable, tan2 = (1.0 - c * c) / (c * c);
            const double slopes = 1.0 / (pi * alpha * alpha * std::pow(1.0 + tan2 / (alpha * alpha), 2.0));
            sum += 2.0 * pi * slopes / (c * c * c * c) / kTable;  // dp dq = d omega / c^3
            area_up_to_.push_back(sum);
        }
    }

    /// Direction in which a ray leaves that comes in `direction` (z < 0) from above.
    glm::dvec3 follow(glm::dvec3 direction, Random& random) const {
        double below = 2.0;  // heights that lie below the ray
        bool above = true;
        for (;;) {
            const double left = std::max(above ? below : 2.0 - below, 1e-12);
            // Candidates come at the rate area() / left. From there, `left` at the next one:
            const double rise = (above ? direction.z : -direction.z) / area_up_to_.back();
            const double next = left * std::pow(1.0 - random.next(), -rise);
            if (next >= 2.0) return direction;
            below = above ? next : 2.0 - next;
            const glm::dvec3 up = any_facet(random), n = above ? up : -up;
            const double cosine = -glm::dot(direction, n);
            if (random.next() >= cosine) continue;
            const double n_here = above ? n_above_ : n_below_, n_there = above ? n_below_ : n_above_;
            if (random.next() < facet_reflectance(cosine, n_here, n_there)) {
                direction = glm::normalize(glm::reflect(direction, n));
            } else {
                direction = glm::normalize(glm::refract(direction, n, n_here / n_there));
                above = !above;
            }
        }
    }

private:
    static constexpr int kTable = 20000;
    glm::dvec3 any_facet(Random& random) const {
        const double area = random.next() * area_up_to_.back();
        const auto cell = std::upper_bound(area_up_to_.begin(), area_up_to_.end(), area) - area_up_to_.begin();
        const double cosine = (double(cell) + random.next()) / kTable;
        return at_angles(cosine, 2.0 * pi * random.next());
    }

    double n_above_, n_below_;
    std::vector<double> area_up_to_;
};

/// Shares of light in 10 x 10 bins of cos theta and phi on each side.
class DirectionBins {
public:
    static constexpr int kAcross = 10, kCount = 2 * kAcross * kAcross;
    static constexpr double kSolidAngle = 4.0 * pi / kCount;

    /// Adds the light in direction w and, as the surface has no handedness, in the mirror image of w.
    void add(const glm::dvec3& w, double share) {
        for (const glm::dvec3& image : {w, glm::dvec3(w.x, -w.y, w.z)}) shares_[bin_of(image)] += 0.5 * share;
    }
    double share(int bin) const { return shares_[std::size_t(bin)]; }
    /// The largest share on the side of `bin`.
    double peak(int bin) const {
        const auto first = shares_.begin() + bin / (kCount / 2) * (kCount / 2);
        return *std::max_element(first, first + kCount / 2);
    }

private:
    static std::size_t bin_of(const glm::dvec3& w) {
        const double turn = 0.5 + std::atan2(w.y, w.x) / (2.0 * pi);
        const int ring = std::min(int(std::abs(w.z) * kAcross), kAcross - 1);
        const int column = std::min(int(turn * kAcross), kAcross - 1);
        return std::size_t(((w.z > 0.0 ? 0 : 1) * kAcross + ring) * kAcross + column);
    }
    std::vector<double> shares_ = std::vector<double>(kCount);
};

/// Expects bins to be within 5% of the peak of their side. The peak holds at least 3000 of the rays and as many
/// from the mirror image, so its standard error is under 1.3%; two such counts differ by 2% at random.
void expect_same_shape(const DirectionBins& found, const DirectionBins& expected) {
    for (int bin = 0; bin < DirectionBins::kCount; ++bin) {
        EXPECT_GT(expected.peak(bin), 0.0015) << "too few rays";
        EXPECT_NEAR(found.share(bin), expected.share(bin), 0.05 * expected.peak(bin)) << "bin " << bin;
    }
}

void expect_shape_of_simulation(double n_o, double n_i, double roughness, double cos_theta_o) {
    SCOPED_TRACE(testing::Message() << "from index " << n_o << " to " << n_i << ", roughness " << roughness);
    constexpr int kRays = 2000000, kEvaluations = 500000;
    const RoughInterface surface = rough_interface(n_o, n_i, roughness);
    const FacetSimulation simulation(roughness * roughness, n_o, n_i);
    const glm::dvec3 wo = at_angles(cos_theta_o, 0.0);
    Random random(24, 0, 0);
    DirectionBins simulated, sampled, evaluated;
    for (int ray = 0; ray < kRays; ++ray) {
        simulated.add(simulation.follow(-wo, random), 1.0 / kRays);
        sampled.add(surface.sample(wo, random), 1.0 / kRays);
    }
    for (int i = 0; i < kEvaluations; ++i) {
        // Points of a spiral are even on the sphere, so that noise is left only where evaluation is at random.
        const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
        const glm::dvec3 wi = on_sphere({(i + 0.5) / kEvaluations, i * golden});
        const double value = surface.single(wo, wi) + surface.multiple(wo, wi, random);
        evaluated.add(wi, value * 4.0 * pi / kEvaluations);
    }
    expect_same_shape(sampled, simulated);
    expect_same_shape(evaluated, simulated);
}

TEST(RoughGlass, ScattersAsSimulatedFacetsSeenFromOutside) {
    // An index of 2.42, so that enough light is reflected to compare its shape.
    expect_shape_of_simulation(1.0, 2.42, 0.5, 0.4);
    expect_shape_of_simulation(1.0, 2.42, 1.0, 0.4);
}

TEST(RoughGlass, ScattersAsSimulatedFacetsSeenFromInside) {
    expect_shape_of_simulation(1.5, 1.0, 0.5, 0.7);
    expect_shape_of_simulation(1.5, 1.0, 1.0, 0.7);
}

}  // namespace
}  // namespace pellucid::reference
