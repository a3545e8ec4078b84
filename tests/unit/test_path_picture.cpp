// What a path-traced picture is as a statistic: repeatable, and honest about its error.
#include "traced_scenes.h"

#include <pellucid/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace pellucid {
namespace {

using namespace test;

/// Rough and smooth glass over a matt floor, and a lamp.
Scene still_life() {
    Scene scene = load_scene("shape:sphere,segments=16");
    scene.materials[0].roughness = 0.4f;
    add(scene, with_flat_normals(cube()), glass(), glm::translate(glm::mat4(1.0f), glm::vec3(1.4f, -0.5f, 0.3f)));
    Material matt;
    matt.roughness = 0.5f;
    Mesh floor = square();
    add(scene, floor, matt,
        glm::translate(glm::mat4(1.0f), glm::vec3(0, -1.1f, 0)) *
            glm::rotate(glm::scale(glm::mat4(1.0f), glm::vec3(3.0f)), -1.5707963f, glm::vec3(1, 0, 0)));
    Light light;
    light.position = {-2, 3, 1};
    light.intensity = glm::vec3(5.0f);
    scene.lights = {light};
    return scene;
}

PathTraceSettings settings_of(std::uint32_t size, std::uint32_t samples, std::uint32_t seed = 1) {
    PathTraceSettings settings;
    settings.width = size;
    settings.height = size - 3;  // no multiple of a tile
    settings.samples = samples;
    settings.seed = seed;
    return settings;
}

TEST(PathPicture, IsTheSameOnAnyNumberOfThreads) {
    const Scene scene = still_life();
    const Camera camera = view_of(scene, 10);
    const Environment environment = load_environment("studio");
    const auto trace_on = [&](std::uint32_t threads, std::uint32_t seed) {
        return Tracer(scene, {.threads = threads}).path_trace(camera, environment, settings_of(40, 4, seed));
    };
    const PathTracedImage one = trace_on(1, 5);
    EXPECT_EQ(one.samples, 4u);
    EXPECT_EQ(one.radiance.height, 37);
    for (const std::uint32_t threads : {2u, 3u, 0u}) {
        const PathTracedImage other = trace_on(threads, 5);
        EXPECT_EQ(one.radiance.pixels, other.radiance.pixels);
        EXPECT_EQ(one.standard_error.pixels, other.standard_error.pixels);
        EXPECT_EQ(one.cut_paths, other.cut_paths);
    }
    EXPECT_NE(one.radiance.pixels, trace_on(0, 6).radiance.pixels);
}

/// Turns everything about +Y, right-handed, but not the environment.
Scene turned(Scene scene, float angle) {
    const glm::mat4 turn = glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0, 1, 0));
    for (Object& object : scene.objects) object.world_from_object = turn * object.world_from_object;
    for (Light& light : scene.lights) light.position = glm::vec3(turn * glm::vec4(light.position, 1.0f));
    return scene;
}

TEST(PathPicture, ATurnedEnvironmentIsTheSceneTurnedTheOtherWay) {
    constexpr float kAngle = 2.1f;
    const Scene scene = still_life(), other = turned(scene, -kAngle);
    Camera camera = view_of(scene, 10), other_camera = camera;
    other_camera.world_from_view = glm::rotate(glm::mat4(1.0f), -kAngle, glm::vec3(0, 1, 0)) * camera.world_from_view;
    Environment environment = load_environment("studio");
    const PathTracedImage expected = Tracer(other).path_trace(other_camera, environment, settings_of(16, 512));
    environment.rotation = kAngle;
    const PathTracedImage found = Tracer(scene).path_trace(camera, environment, settings_of(16, 512));
    double square = 0.0, difference = 0.0;
    for (std::size_t i = 0; i < found.radiance.pixels.size(); ++i) {
        const double error =
            std::hypot(double(found.standard_error.pixels[i]), double(expected.standard_error.pixels[i])) + 1e-3;
        const double off = double(found.radiance.pixels[i] - expected.radiance.pixels[i]);
        EXPECT_LT(std::abs(off), 6.0 * error) << i;
        square += off * off / (error * error);
        difference += off;
    }
    EXPECT_LT(square / double(found.radiance.pixels.size()), 1.5);
    EXPECT_NEAR(difference / double(found.radiance.pixels.size()), 0.0, 4e-3);
}

TEST(PathPicture, IntensityScalesTheEnvironmentsShare) {
    Scene scene = still_life();
    scene.lights.clear();
    const Camera camera = view_of(scene, 10);
    Environment environment = load_environment("sky");
    const Tracer tracer(scene);
    const PathTracedImage one = tracer.path_trace(camera, environment, settings_of(12, 16));
    environment.intensity = 4.0f;
    const PathTracedImage four = tracer.path_trace(camera, environment, settings_of(12, 16));
    for (std::size_t i = 0; i < one.radiance.pixels.size(); ++i)
        EXPECT_NEAR(four.radiance.pixels[i], 4.0f * one.radiance.pixels[i], 1e-4f * (1.0f + four.radiance.pixels[i]));
}

TEST(PathPicture, SeedsAgreeAndTheStandardErrorIsTheirSpread) {
    const Scene scene = still_life();
    const Tracer tracer(scene);
    const Camera camera = view_of(scene, 10);
    const Environment environment = load_environment("studio");
    constexpr std::uint32_t kSeeds = 32;
    std::vector<double> sum, squares, stated;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        const PathTracedImage image = tracer.path_trace(camera, environment, settings_of(16, 64, seed));
        const std::size_t count = image.radiance.pixels.size();
        sum.resize(count), squares.resize(count), stated.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            const double value = double(image.radiance.pixels[i]), error = double(image.standard_error.pixels[i]);
            ASSERT_TRUE(std::isfinite(value) && std::isfinite(error));
            sum[i] += value;
            squares[i] += value * value;
            stated[i] += error * error / kSeeds;
        }
    }
    double spread = 0.0, claimed = 0.0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
        spread += (squares[i] - sum[i] * sum[i] / kSeeds) / (kSeeds - 1);
        claimed += stated[i];
    }
    EXPECT_NEAR(std::sqrt(claimed / spread), 1.0, 0.1);
    const PathTracedImage single = tracer.path_trace(camera, environment, settings_of(16, 1));
    EXPECT_EQ(single.standard_error.pixels, std::vector<float>(single.radiance.pixels.size(), 0.0f));
}

/// A matt floor under a map with a sun of one texel: what it shows, by quadrature, and how far apart single
/// samples would lie if the floor alone chose their directions.
struct Lit {
    double radiance = 0.0, deviation = 0.0;
};
Lit floor_under(const Environment& environment) {
    constexpr int kSteps = 2000;
    Lit lit;
    double squares = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        for (int k = 0; k < kSteps; ++k) {
            const double radius = std::sqrt((i + 0.5) / kSteps), angle = 2.0 * std::numbers::pi * (k + 0.5) / kSteps;
            const glm::vec3 d(radius * std::cos(angle), std::sqrt(1.0 - radius * radius), radius * std::sin(angle));
            const double value = double(radiance(environment, d).r) / (double(kSteps) * kSteps);
            lit.radiance += value;
            squares += value * value * double(kSteps) * kSteps;
        }
    }
    lit.deviation = std::sqrt(squares - lit.radiance * lit.radiance);
    return lit;
}

TEST(PathPicture, ASmallSunIsFoundByItsBrightness) {
    Environment environment;
    environment.kind = Environment::Kind::kMap;
    environment.map = Image(128, 64, 3);
    for (float& value : environment.map.pixels) value = 0.2f;
    for (int c = 0; c < 3; ++c) environment.map.at(30, 14)[c] = 1e4f;
    Material white;
    white.roughness = 1.0f;
    white.ior = 1.0f;
    Scene scene = scene_of(square(), white);
    scene.objects[0].world_from_object = glm::rotate(glm::mat4(1.0f), -1.5707963f, glm::vec3(1, 0, 0));
    constexpr std::uint32_t kSamples = 4000;
    PathTraceSettings settings;
    settings.width = settings.height = 1;
    settings.samples = kSamples;
    const PathTracedImage image =
        Tracer(scene).path_trace(parallel_camera({0.1f, 0, 0.2f}, {0, -1, 0}, 1e-3f), environment, settings);
    const Lit expected = floor_under(environment);
    const double error = double(image.standard_error.pixels[0]);
    EXPECT_NEAR(double(image.radiance.pixels[0]), expected.radiance, 4.0 * error + 1e-3 * expected.radiance);
    EXPECT_LT(error, 0.1 * expected.deviation / std::sqrt(double(kSamples))) << "a hundredth of the variance";
}

TEST(PathPicture, CutPathsAreCounted) {
    const Scene scene = load_scene("shape:sphere,segments=16");
    Environment white;
    white.kind = Environment::Kind::kUniform;
    PathTraceSettings settings = settings_of(16, 8);
    const Camera inside_view = parallel_camera(glm::vec3(0), {0, 0, -1}, 0.5f);  // sees nothing but glass
    const auto cut = [&](std::uint32_t max_vertices) {
        settings.max_vertices = max_vertices;
        const PathTracedImage image = Tracer(scene).path_trace(inside_view, white, settings);
        double missing = 0.0;
        for (const float value : image.radiance.pixels) missing += (1.0 - double(value)) / 3.0 * settings.samples;
        EXPECT_NEAR(missing, double(image.cut_paths), 0.01);
        return double(image.cut_paths) / (16 * 13 * 8);
    };
    EXPECT_NEAR(cut(1), 0.96, 0.03) << "all that is not reflected by the first surface";
    EXPECT_NEAR(cut(2), 0.04, 0.03) << "reflected inside";
    EXPECT_EQ(cut(64), 0.0);
}

TEST(PathPicture, PixelsLookWhereTheExactTracerDoes) {
    // A pixel without a surface shows the mean of the background over its area.
    Scene scene = scene_of(square());
    scene.objects[0].world_from_object = glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, 100));
    const Camera camera = orbit_camera({}, 30, 20, 5, 0.8f);
    const Environment environment = load_environment("checker");
    const PathTraceSettings settings = settings_of(24, 64);
    const PathTracedImage image = Tracer(scene).path_trace(camera, environment, settings);
    ExactSettings exact_settings;
    exact_settings.width = settings.width;
    exact_settings.height = settings.height;
    const std::vector<RefractedPath> paths = Tracer(scene).exact(camera, exact_settings);
    int alike = 0, flat = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (image.standard_error.pixels[3 * i] > 1e-6f) continue;  // an edge of the pattern
        ++flat;
        alike += std::abs(image.radiance.pixels[3 * i] - radiance(environment, paths[i].direction).r) < 1e-4f;
    }
    EXPECT_GT(flat, 100);
    EXPECT_EQ(alike, flat);
}

TEST(PathPicture, ProgressGrowsToOneAndWrongSettingsAreErrors) {
    const Scene scene = load_scene("shape:cube");
    const Tracer tracer(scene);
    const Camera camera = view_of(scene, 0);
    const Environment environment = load_environment("studio");
    std::vector<double> shares;
    tracer.path_trace(camera, environment, settings_of(50, 1), [&](double share) { shares.push_back(share); });
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_GT(shares.size(), 3u);
    EXPECT_EQ(shares.back(), 1.0);

    for (const auto change : std::vector<void (*)(PathTraceSettings&)>{
             [](PathTraceSettings& s) { s.width = 0; }, [](PathTraceSettings& s) { s.height = 0; },
             [](PathTraceSettings& s) { s.samples = 0; }, [](PathTraceSettings& s) { s.max_vertices = 0; }}) {
        PathTraceSettings settings = settings_of(8, 1);
        change(settings);
        EXPECT_THROW(tracer.path_trace(camera, environment, settings), Error);
    }
    Camera broken = camera;
    broken.vertical_fov = 0.0f;
    EXPECT_THROW(tracer.path_trace(broken, environment, settings_of(8, 1)), Error);
}

}  // namespace
}  // namespace pellucid
