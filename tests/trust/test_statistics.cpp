// Pixels of the path tracer as estimates: z-tests against closed forms and against other seeds, as Subr & Arvo,
// "Statistical hypothesis testing for assessing Monte Carlo estimators" (2007), with Sidak's correction.
#include "trust/trust_scenes.h"
#include "unit/traced_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pellucid::test {
namespace {

constexpr double kSignificance = 0.01;  // of all values of an image together
constexpr double kLeastShare = 0.9975;
constexpr double kRounding = 2e-4;  // relative; for values that have no spread

/// Share of the values that agree with `expected`, each at a level that Sidak's correction gives.
template <class Expected>
double share_that_agrees(const PathTracedImage& image, const Expected& expected) {
    const std::size_t count = image.radiance.pixels.size();
    const double level = 1.0 - std::pow(1.0 - kSignificance, 1.0 / double(count));
    std::size_t agree = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto [value, error] = expected(i);
        const double spread = std::hypot(double(image.standard_error.pixels[i]), error);
        const double apart = std::abs(double(image.radiance.pixels[i]) - value);
        const double p = spread > 0.0 ? std::erfc(apart / spread / std::numbers::sqrt2) : 0.0;
        agree += p > level || apart <= kRounding * (1.0 + value) ? 1 : 0;
    }
    return double(agree) / double(count);
}

double share_near(const PathTracedImage& image, const glm::dvec3& value) {
    return share_that_agrees(image, [&](std::size_t i) { return std::pair(value[glm::length_t(i % 3)], 0.0); });
}

PathTraceSettings settings_of(std::uint32_t samples, std::uint32_t seed = 1) {
    PathTraceSettings settings;
    settings.width = settings.height = 32;
    settings.samples = samples;
    settings.seed = seed;
    return settings;
}

/// Radiance 1 + the vertical component of the direction.
Environment brighter_above() {
    Environment environment;
    environment.kind = Environment::Kind::kMap;
    environment.map = Image(4, 512, 3);
    for (int y = 0; y < environment.map.height; ++y)
        for (int x = 0; x < environment.map.width; ++x)
            for (int c = 0; c < 3; ++c)
                environment.map.at(x, y)[c] =
                    1.0f + float(std::cos(std::numbers::pi * (y + 0.5) / environment.map.height));
    return environment;
}

TEST(ZTests, MattFloorUnderAGradient) {
    Scene scene = load_scene("shape:cube");
    scene.meshes = {floor_at(0.0f)};
    scene.materials = {matt(0.5f)};
    const Camera camera = parallel_camera({0, 0, 0}, glm::normalize(glm::vec3(0.3f, -1, 0.2f)), 2.0f);
    const PathTracedImage image = Tracer(scene).path_trace(camera, brighter_above(), settings_of(256));
    // The cosine-weighted mean of 1 + y over the hemisphere is 1 + 2/3.
    EXPECT_GE(share_near(image, glm::dvec3(0.5 * (1.0 + 2.0 / 3.0))), kLeastShare);
    EXPECT_LT(share_near(image, glm::dvec3(0.5 * (1.0 + 2.0 / 3.0) * 1.2)), kLeastShare) << "the test is blind";
}

TEST(ZTests, SlabOfAbsorbingGlass) {
    const double ior = 1.5, a = std::exp(-0.7), r = std::pow((ior - 1) / (ior + 1), 2);
    LoadOptions options;
    options.ior = float(ior);
    Scene scene = load_scene("shape:slab,width=4,height=4,thickness=0.5", options);
    scene.materials[0].attenuation_color = glm::vec3(float(a));
    scene.materials[0].attenuation_distance = 0.5f;
    const double through = (1 - r) * (1 - r) * a / (1 - r * r * a * a);
    const double back = r + (1 - r) * (1 - r) * r * a * a / (1 - r * r * a * a);
    const Camera camera = parallel_camera({0.1f, 0.1f, 0}, {0, 0, -1}, 1.0f);
    const PathTracedImage image = Tracer(scene).path_trace(camera, two_sides(), settings_of(1024));
    EXPECT_GE(share_near(image, {through, back, 0}), kLeastShare);
    EXPECT_LT(share_near(image, {0.8 * through, back, 0}), kLeastShare) << "the test is blind";
}

TEST(ZTests, RoughGlassInTheFurnace) {
    Scene scene = load_scene("shape:sphere,segments=48");
    scene.materials[0].roughness = 0.3f;
    Environment one;
    one.kind = Environment::Kind::kUniform;
    one.uniform_radiance = glm::vec3(1.0f);
    const PathTracedImage image = Tracer(scene).path_trace(view_of(scene, 0), one, settings_of(128));
    EXPECT_GE(share_near(image, glm::dvec3(1.0)), kLeastShare);
}

TEST(ZTests, SeedsAgree) {
    for (Scene scene : {table_scene(), crowd_scene()}) {
        scene.lights.clear();  // photons have a kernel, and so a bias
        const Tracer tracer(scene);
        const Environment environment = load_environment("studio");
        const Camera camera = view_of(scene, 10);
        const PathTracedImage one = tracer.path_trace(camera, environment, settings_of(256, 1));
        const PathTracedImage other = tracer.path_trace(camera, environment, settings_of(256, 77));
        EXPECT_GE(share_that_agrees(one,
                                    [&](std::size_t i) {
                                        return std::pair(double(other.radiance.pixels[i]),
                                                         double(other.standard_error.pixels[i]));
                                    }),
                  kLeastShare);
    }
}

}  // namespace
}  // namespace pellucid::test
