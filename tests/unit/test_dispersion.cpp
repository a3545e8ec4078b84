// Dispersion in the truth: the indices of the colour channels, and the paths that follow them.
#include "optics/interface.h"
#include "reference/bsdf.h"
#include "reference/media.h"
#include "test_files.h"
#include "traced_scenes.h"

#include <pellucid/reference.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace pellucid {
namespace {

using namespace test;

TEST(ChannelIndices, FollowTheAbbeNumberAndAgreeWithTheRenderer) {
    const double ior = 1.5168, abbe = 64.17;  // crown glass, Schott N-BK7
    const glm::dvec3 crown = reference::channel_iors(ior, 20.0 / abbe);
    EXPECT_EQ(crown.g, ior);
    EXPECT_NEAR((ior - 1.0) / (crown.b - crown.r), abbe, 1e-9);
    EXPECT_NEAR(crown.b - crown.g, crown.g - crown.r, 1e-12);
    EXPECT_FALSE(reference::Medium{reference::channel_iors(1.7, 0.0)}.disperses());
    EXPECT_FALSE(reference::Medium{reference::channel_iors(1.0, 5.0)}.disperses());
    EXPECT_TRUE(reference::Medium{crown}.disperses());
    for (const double n : {1.0, 1.33, 1.5, 2.42}) {
        for (const double dispersion : {0.0, 0.1, 1.0, 5.0, 40.0, 100.0}) {  // from 40 on red stays at 1
            const glm::dvec3 own = reference::channel_iors(n, dispersion), other = ior_per_channel(n, dispersion);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(own[c], other[c], 1e-14) << n << " " << dispersion << " " << c;
        }
    }
}

/// Glass of index 1.3125 for red, 1.5 for green and 1.6875 for blue: all are exact in single precision.
Material flint() {
    Material material = glass(1.5f);
    material.dispersion = 15.0f;
    return material;
}

/// `scene` with the index that one channel has in it, for all light.
Scene in_light_of(const Scene& scene, int channel) {
    Scene plain = scene;
    for (Material& m : plain.materials) {
        m.ior = float(reference::channel_iors(double(m.ior), double(m.dispersion))[channel]);
        m.dispersion = 0.0f;
    }
    return plain;
}

TEST(ExactDispersion, PrismDeviatesEachChannelByItsIndex) {
    const float h = std::sqrt(3.0f);
    const Scene scene = scene_of(prism({-1, 0}, {1, 0}, {0, h}), flint());
    const Tracer tracer(scene);
    const double apex = glm::radians(60.0);
    const glm::dvec3 left_normal(-std::cos(apex / 2), std::sin(apex / 2), 0.0), along(left_normal.y, -left_normal.x, 0);
    const std::array indices{1.3125, 1.5, 1.6875};
    for (const double i : {0.75, 0.85, 0.95}) {
        const glm::dvec3 d = -std::cos(i) * left_normal - std::sin(i) * along;
        const Camera camera = parallel_camera({-0.5f, 0.5f * h, 0.0f}, glm::vec3(d), 0.01f);
        for (std::uint32_t channel = 0; channel < 3; ++channel) {
            const double n = indices[channel], e = std::asin(n * std::sin(apex - std::asin(std::sin(i) / n)));
            ExactSettings settings{.width = 1, .height = 1, .channel = channel};
            const RefractedPath path = tracer.exact(camera, settings).front();
            EXPECT_EQ(path.events, 2);
            EXPECT_NEAR(angle_deg(d, path.direction), glm::degrees(i + e - apex), 1e-4) << i << " channel " << channel;
            glm::vec3 fast;
            tracer.trace_fast(camera, settings, {&fast, 1});
            EXPECT_LT(angle_deg(path.direction, fast), 1e-3) << i << " channel " << channel;
            if (channel == 1) {
                EXPECT_TRUE(same_bits(path, tracer.exact(camera, {.width = 1, .height = 1}).front()));
            }
        }
    }
}

/// A rough, tinted, absorbing block with a ball of another dispersive glass in it, on a coloured floor
/// under a lamp.
Scene still_life() {
    Material block = flint();
    block.roughness = 0.05f;
    block.base_color = {0.9f, 0.8f, 0.7f, 1.0f};
    block.attenuation_color = {0.7f, 0.9f, 0.8f};
    Material ball = glass(2.0f);
    ball.dispersion = 15.0f;  // 1.625, 2, 2.375
    Scene scene = scene_of(with_flat_normals(cube()), block);
    add(scene, load_scene("shape:sphere,segments=24").meshes[0], ball, glm::scale(glm::mat4(1), glm::vec3(0.9f)));
    Material matt;
    matt.base_color = {0.1f, 0.2f, 0.3f, 1.0f};
    matt.roughness = 0.6f;
    add(scene, square(), matt,
        glm::translate(glm::mat4(1), glm::vec3(0, -1.1f, 0)) *
            glm::rotate(glm::scale(glm::mat4(1), glm::vec3(3.0f)), -1.5707963f, glm::vec3(1, 0, 0)));
    Light light;
    light.position = {-2, 3, 1};
    light.intensity = glm::vec3(20.0f);
    scene.lights = {light};
    return scene;
}

Scene flint_sphere() {
    Scene scene = load_scene("shape:sphere,segments=48");
    scene.materials[0] = flint();
    return scene;
}

TEST(ExactDispersion, PathsOfAChannelAreThoseOfGlassOfItsIndex) {
    for (const Scene& scene : {flint_sphere(), still_life()}) {
        const Camera camera = view_of(scene, 20.0f);
        for (std::uint32_t channel = 0; channel < 3; ++channel) {
            ExactSettings settings{.width = 48, .height = 48, .channel = channel};
            const Scene plain = in_light_of(scene, int(channel));
            const std::vector<RefractedPath> paths = Tracer(scene).exact(camera, settings);
            EXPECT_EQ(count_different(paths, trace(plain, camera, 48)), 0u) << channel;
            settings.packet = 4;
            EXPECT_EQ(count_different(paths, Tracer(scene).exact(camera, settings)), 0u) << channel;
        }
    }
}

PathTracedImage path_trace(const Scene& scene, const Camera& camera, const Environment& environment, std::uint32_t size,
                           std::uint32_t samples, std::uint32_t seed) {
    return Tracer(scene).path_trace(camera, environment,
                                    {.width = size, .height = size, .samples = samples, .seed = seed});
}

/// How far apart two pictures are in one channel, in standard errors of their difference.
struct Apart {
    double in_sum = 0.0;       ///< of the mean of all pixels
    double mean_square = 0.0;  ///< over the pixels: 1 if nothing but noise is between them
};
Apart compare(const PathTracedImage& a, const PathTracedImage& b, std::size_t channel) {
    double difference = 0.0, variance = 0.0, squares = 0.0;
    for (std::size_t i = channel; i < a.radiance.pixels.size(); i += 3) {
        const double d = double(a.radiance.pixels[i]) - double(b.radiance.pixels[i]);
        const double v =
            std::pow(double(a.standard_error.pixels[i]), 2) + std::pow(double(b.standard_error.pixels[i]), 2);
        difference += d;
        variance += v;
        squares += d * d / (v + 1e-12);
    }
    return {std::abs(difference) / std::sqrt(variance), squares / (double(a.radiance.pixels.size()) / 3.0)};
}

TEST(PathDispersion, APictureIsThoseOfItsThreeChannels) {
    const Environment environment = load_environment("studio");
    for (const Scene& scene : {flint_sphere(), still_life()}) {
        const Camera camera = view_of(scene, 20.0f);
        const PathTracedImage picture = path_trace(scene, camera, environment, 32, 2048, 1);
        std::array<PathTracedImage, 3> channels;
        for (int c = 0; c < 3; ++c)
            channels[std::size_t(c)] =
                path_trace(in_light_of(scene, c), camera, environment, 32, 1024, 2 + unsigned(c));
        for (std::size_t c = 0; c < 3; ++c) {
            const Apart own = compare(picture, channels[c], c), other = compare(picture, channels[(c + 1) % 3], c);
            EXPECT_LT(own.in_sum, 4.0) << c;
            EXPECT_NEAR(own.mean_square, 1.0, 0.15) << c;
            EXPECT_GT(other.in_sum, 5.0) << "channels differ by more than the noise: " << c;
        }
    }
}

/// What a path straight through a slab shows, by the random numbers that it draws: two for the place in the pixel,
/// one for the channel if colours part, one at every face.
glm::vec3 replay(std::uint64_t pixel, bool disperses, const Environment& ahead_and_behind) {
    reference::Random random(7, pixel, 0);
    random.next2();
    glm::dvec3 throughput(1.0);
    double n = 1.5;
    if (disperses) {
        const int channel = int(3.0 * random.next());
        n = std::array{1.3125, 1.5, 1.6875}[std::size_t(channel)];
        throughput = glm::dvec3(0.0);
        throughput[channel] = 3.0;
    }
    const reference::InterfaceBsdf in(1.0, n, 0.0, glm::dvec3(1.0)), out(n, 1.0, 0.0, glm::dvec3(1.0));
    bool forwards = in.sample({0, 0, 1}, random)->wi.z < 0.0;
    if (forwards) {
        while (out.sample({0, 0, 1}, random)->wi.z > 0.0) forwards = !forwards;
    }
    return glm::vec3(throughput) * radiance(ahead_and_behind, glm::vec3(0, 0, forwards ? -1 : 1));
}

TEST(PathDispersion, OnlyDispersionDrawsARandomNumberForTheChannel) {
    constexpr std::uint32_t kSize = 24;
    const Environment environment = two_sides({1, 2, 3}, {4, 5, 6});
    for (const bool disperses : {false, true}) {
        Scene scene = load_scene("shape:slab");
        scene.materials[0] = disperses ? flint() : glass(1.5f);
        const PathTracedImage image =
            path_trace(scene, parallel_camera({0.1f, 0.1f, 0}, {0, 0, -1}, 0.1f), environment, kSize, 1, 7);
        std::size_t alike = 0;
        for (std::uint64_t pixel = 0; pixel < kSize * kSize; ++pixel) {
            const float* shown = &image.radiance.pixels[3 * pixel];
            alike += glm::vec3(shown[0], shown[1], shown[2]) == replay(pixel, disperses, environment);
        }
        EXPECT_EQ(alike, kSize * kSize) << disperses;
    }
}

TEST(PathDispersion, ChannelsAreChosenByWhatThePathCarries) {
    // Behind a red pane only red is left: no path is spent on the others, and the noise is that of plain glass.
    Material pane = glass();
    pane.thickness = 0.0f;
    pane.base_color = {1.0f, 0.0f, 0.0f, 1.0f};
    Scene scene = flint_sphere();
    add(scene, square(), pane, glm::translate(glm::mat4(1), glm::vec3(0, 0, 2)));
    const Camera camera = parallel_camera(glm::vec3(0), {0, 0, -1}, 1.2f);
    const Environment environment = load_environment("studio");
    const auto noise = [&](const Scene& of) {
        double sum = 0.0;
        const PathTracedImage image = path_trace(of, camera, environment, 16, 256, 1);
        for (std::size_t i = 0; i < image.standard_error.pixels.size(); i += 3)
            sum += double(image.standard_error.pixels[i]);
        return sum;
    };
    EXPECT_LT(noise(scene), 1.2 * noise(in_light_of(scene, 0)));
}

TEST(PathDispersion, PrismsOfTheDispersionTestShowColouredFringes) {
    if (data_folder().empty()) GTEST_SKIP() << "PELLUCID_TEST_DATA does not name a folder";
    const Scene scene = load_scene((data_folder() / "gltf/dispersion-test/dispersion-test.glb").string());
    const Camera camera =
        parallel_camera({0.0375f, -0.0075f, 0}, {0, 0, -1}, 0.045f, 0.2f);  // black and white but for the prisms
    const auto coloured = [&](const Scene& of) {
        const PathTracedImage image = path_trace(of, camera, uniform(1.0f), 48, 256, 1);
        std::size_t count = 0;
        for (std::size_t i = 0; i < image.radiance.pixels.size(); i += 3) {
            const float *rgb = &image.radiance.pixels[i], *error = &image.standard_error.pixels[i];
            count += std::abs(rgb[0] - rgb[2]) > 5.0f * std::hypot(error[0], error[2]) + 0.01f;
        }
        return count;
    };
    EXPECT_GT(coloured(scene), 40u);
    EXPECT_EQ(coloured(in_light_of(scene, 1)), 0u);
}

}  // namespace
}  // namespace pellucid
