// z-tests of the path tracer (Subr & Arvo 2007, "Statistical hypothesis testing for assessing Monte Carlo estimators").
// The level of 1% for a whole picture is divided among its pixels as Sidak does.
#include "gpu/gpu_test.h"
#include "unit/built_scenes.h"

#include <pellucid/reference.h>

namespace pellucid::test {
namespace {

constexpr double kLevel = 0.01, kLeastShare = 0.9975;
constexpr std::uint32_t kSize = 32;

/// Share of the values that a two-sided z-test does not reject.
class ZTest {
public:
    explicit ZTest(std::size_t count) : level_(1.0 - std::pow(1.0 - kLevel, 1.0 / double(count))), count_(count) {}
    void add(double difference, double error) {
        // Noise below the rounding of floats says nothing.
        const double z = std::abs(difference) / std::max(error, 1e-6);
        passed_ += std::erfc(z / std::sqrt(2.0)) >= level_ ? 1 : 0;
    }
    double share() const { return double(passed_) / double(count_); }

private:
    double level_;
    std::size_t count_, passed_ = 0;
};

double share_of(const PathTracedImage& image, double expected) {
    ZTest test(image.radiance.pixels.size());
    for (std::size_t i = 0; i < image.radiance.pixels.size(); ++i)
        test.add(double(image.radiance.pixels[i]) - expected, double(image.standard_error.pixels[i]));
    return test.share();
}

double share_of(const PathTracedImage& a, const PathTracedImage& b) {
    ZTest test(a.radiance.pixels.size());
    for (std::size_t i = 0; i < a.radiance.pixels.size(); ++i) {
        test.add(double(a.radiance.pixels[i]) - double(b.radiance.pixels[i]),
                 std::hypot(double(a.standard_error.pixels[i]), double(b.standard_error.pixels[i])));
    }
    return test.share();
}

PathTraceSettings settings_of(std::uint32_t samples, std::uint32_t seed = 1) {
    return {.width = kSize, .height = kSize, .samples = samples, .seed = seed};
}

/// Along -Z, parallel rays over a square of `extent` metres.
Camera straight_camera(float extent) {
    Camera camera;
    camera.world_from_view[3] = glm::vec4(0.0f, 0.0f, 10.0f, 1.0f);
    camera.orthographic = true;
    camera.vertical_extent = extent;
    return camera;
}

/// A slab of glass 1 m thick, much wider than the picture.
Scene slab(const Material& material) {
    Scene scene = load_scene("shape:cube");
    const Bounds bounds = scene_bounds(scene);
    glm::mat4 placed(1.0f);
    placed[0][0] = placed[1][1] = 50.0f / bounds.half_size.x;
    placed[2][2] = 0.5f / bounds.half_size.z;
    placed[3] = -placed * glm::vec4(bounds.center, 1.0f);
    placed[3].w = 1.0f;
    scene.objects.front().world_from_object = placed * scene.objects.front().world_from_object;
    scene.materials.front() = material;
    return scene;
}

/// R + T of an absorbing slab at normal incidence, all reflections inside summed.
double reflected_and_transmitted(double ior, double inside) {
    const double r = std::pow((ior - 1.0) / (ior + 1.0), 2.0), t = 1.0 - r;
    const double all = 1.0 / (1.0 - r * r * inside * inside);
    return r + t * t * r * inside * inside * all + t * t * inside * all;
}

TEST(Noise, OfAnAbsorbingSlabIsAroundTheSumOfItsReflections) {
    Material material = glass(2.0f);
    material.attenuation_color = glm::vec3(0.4f);
    material.attenuation_distance = 1.0f;
    const Scene scene = slab(material);
    const PathTracedImage image = Tracer(scene).path_trace(straight_camera(1.0f), uniform(1.0f), settings_of(1024));
    const double expected = reflected_and_transmitted(2.0, 0.4);
    ASSERT_GT(image.standard_error.pixels[0], 1e-4f) << "a picture without noise tests nothing";
    EXPECT_GE(share_of(image, expected), kLeastShare);
    EXPECT_LT(share_of(image, 1.1 * expected), kLeastShare) << "the test is blind";
}

TEST(Noise, OfADiffusePlaneUnderAHalfLitSkyIsAroundItsClosedForm) {
    Scene scene = scene_of(square(), Material{});
    Material& white = scene.materials.front();
    white.base_color = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
    white.transmission = 0.0f;
    white.ior = 1.0f;  // no reflection above the diffuse layer
    // Radiance 2 where x > 0, else 0: the plane that faces +Z sees the half of either.
    Environment halves;
    halves.kind = Environment::Kind::kMap;
    halves.map = Image(512, 2, 3);
    for (int y = 0; y < 2; ++y)
        for (int x = 128; x < 384; ++x)
            for (int c = 0; c < 3; ++c) halves.map.at(x, y)[c] = 2.0f;
    const PathTracedImage image = Tracer(scene).path_trace(straight_camera(1.0f), halves, settings_of(1024));
    const double expected = 0.5;
    ASSERT_GT(image.standard_error.pixels[0], 1e-4f);
    EXPECT_GE(share_of(image, expected), kLeastShare);
    EXPECT_LT(share_of(image, 1.1 * expected), kLeastShare) << "the test is blind";
}

TEST(Noise, OfIndependentSeedsIsIndependent) {
    for (const char* source : {"shape:goblet", "shape:gem"}) {
        SCOPED_TRACE(source);
        const Scene scene = load_scene(source);
        const Camera camera = framing_camera(scene_bounds(scene), kSize, kSize, 0.5f);
        const Environment environment = load_environment("studio");
        const Tracer tracer(scene);
        const PathTracedImage one = tracer.path_trace(camera, environment, settings_of(512, 1));
        const PathTracedImage two = tracer.path_trace(camera, environment, settings_of(512, 2));
        EXPECT_NE(one.radiance.pixels, two.radiance.pixels);
        EXPECT_GE(share_of(one, two), kLeastShare);
        // The standard error says how far two pictures are apart: neither too much nor too little.
        double squares = 0.0;
        int noisy = 0;
        for (std::size_t i = 0; i < one.radiance.pixels.size(); ++i) {
            const double error = std::hypot(double(one.standard_error.pixels[i]), double(two.standard_error.pixels[i]));
            if (error < 1e-4) continue;
            squares += std::pow((double(one.radiance.pixels[i]) - double(two.radiance.pixels[i])) / error, 2.0);
            ++noisy;
        }
        ASSERT_GT(noisy, 100);
        EXPECT_NEAR(squares / noisy, 1.0, 0.2);
    }
}

}  // namespace
}  // namespace pellucid::test
