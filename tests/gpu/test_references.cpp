// The techniques that trace rays on the CPU, as Renderer draws them.
#include "gpu/gpu_test.h"

#include <algorithm>

namespace pellucid::test {
namespace {

constexpr std::uint32_t kSize = 96;

class References : public RendererTest {
protected:
    RenderSettings settings_for(std::string technique) {
        RenderSettings settings;
        settings.width = settings.height = kSize;
        settings.technique = std::move(technique);
        return settings;
    }
    void set_up(const std::string& scene, const Environment& environment, const LoadOptions& options = {}) {
        renderer().set_scene(load_scene(scene, options));
        renderer().set_environment(environment);
    }
};

Environment sky() { return load_environment("sky"); }

/// Share of the covered pixels of `exact` where both directions are within 1 degree.
double agreement(const std::vector<RefractedPath>& exact, const std::vector<RefractedPath>& other) {
    int covered = 0, equal = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        if (exact[i].events == 0) continue;
        ++covered;
        equal += angle_deg(exact[i].direction, other[i].direction) < 1.0 ? 1 : 0;
    }
    return covered > 0 ? double(equal) / covered : 0.0;
}

TEST_F(References, ReferenceDrawsTheTracersPaths) {
    set_up("shape:knot", sky());
    RenderSettings settings = settings_for("reference");
    settings.paths = true;
    settings.aovs = {"exit-direction", "events", "status", "exit-object"};
    const RenderResult result = renderer().render(settings);

    const Camera camera = framing_camera(scene_bounds(load_scene("shape:knot")), kSize, kSize, Camera{}.vertical_fov);
    const std::vector<RefractedPath> traced = renderer().tracer().exact(camera, {.width = kSize, .height = kSize});
    ASSERT_EQ(result.paths.size(), traced.size());
    std::uint64_t covered = 0;
    for (std::size_t i = 0; i < traced.size(); ++i) {
        EXPECT_EQ(result.paths[i].direction, traced[i].direction);
        EXPECT_EQ(result.paths[i].position, traced[i].position);
        EXPECT_EQ(result.paths[i].transmittance, traced[i].transmittance);
        EXPECT_EQ(result.paths[i].length_inside, traced[i].length_inside);
        EXPECT_EQ(result.paths[i].events, traced[i].events);
        EXPECT_EQ(result.paths[i].reflections, traced[i].reflections);
        EXPECT_EQ(result.paths[i].status, traced[i].status);
        EXPECT_EQ(result.paths[i].object, traced[i].object);
        covered += traced[i].events > 0 ? 1 : 0;
    }
    EXPECT_GT(covered, 1000u);
    EXPECT_EQ(result.covered, covered);
    EXPECT_EQ(rgb(result.aovs.at("exit-direction"), 48, 40), result.paths[40 * kSize + 48].direction);
    EXPECT_TRUE(all_finite(result.radiance));
}

TEST_F(References, PathsAreThoseOfTheAovs) {
    set_up("shape:torus", sky());
    RenderSettings settings = settings_for("wang-2014");
    settings.paths = true;
    settings.aovs = {"exit-direction", "exit-position", "events", "status", "path-length", "exit-object"};
    const RenderResult result = renderer().render(settings);
    for (std::uint32_t y = 0; y < kSize; ++y) {
        for (std::uint32_t x = 0; x < kSize; ++x) {
            const RefractedPath& path = result.paths[y * kSize + x];
            const int ix = int(x), iy = int(y);
            EXPECT_EQ(path.direction, rgb(result.aovs.at("exit-direction"), ix, iy));
            EXPECT_EQ(path.position, rgb(result.aovs.at("exit-position"), ix, iy));
            EXPECT_EQ(float(path.events), result.aovs.at("events").at(ix, iy)[0]);
            EXPECT_EQ(float(path.reflections), result.aovs.at("events").at(ix, iy)[1]);
            EXPECT_EQ(float(path.status), *result.aovs.at("status").at(ix, iy));
            EXPECT_EQ(path.length_inside, *result.aovs.at("path-length").at(ix, iy));
            EXPECT_EQ(path.object, -1);
            EXPECT_EQ(*result.aovs.at("exit-object").at(ix, iy), -1.0f);
        }
    }
}

// Two interfaces are all that a sphere has, so the picture by layers equals the exact one but for the rim.
TEST_F(References, WangDrawsTheReferencesSphere) {
    set_up("shape:sphere", sky());
    RenderSettings settings = settings_for("reference");
    settings.paths = true;
    const RenderResult exact = renderer().render(settings);
    settings.technique = "wang-2014";
    const RenderResult wang = renderer().render(settings);
    EXPECT_GT(agreement(exact.paths, wang.paths), 0.99);
    EXPECT_LT(std::abs(double(exact.covered) - double(wang.covered)), 8.0);  // pixel centres on the silhouette
    EXPECT_LT(rmse(exact.display, wang.display), 0.02);
}

TEST_F(References, EventsLimitTheReference) {
    set_up("shape:torus", sky());
    RenderSettings settings = settings_for("reference");
    settings.parameters["events"] = 1;
    const RenderResult result = renderer().render(settings);
    EXPECT_EQ(result.status[std::size_t(Status::kEventLimit)], result.covered);
    settings.parameters["events"] = 5000;
    EXPECT_THROW(renderer().render(settings), Error);
}

TEST_F(References, SamplesOfTheReferenceAreAveraged) {
    set_up("shape:cube", load_environment("checker"));
    RenderSettings settings = settings_for("reference");
    const RenderResult one = renderer().render(settings);
    settings.samples = 16;
    double last = -1.0;
    settings.progress = [&](double share) {
        EXPECT_GE(share, last - 1e-9);
        EXPECT_LE(share, 1.0 + 1e-9);
        last = share;
    };
    const RenderResult many = renderer().render(settings);
    EXPECT_NEAR(last, 1.0, 1e-6);
    EXPECT_EQ(many.frames.size(), 16u);
    EXPECT_EQ(many.covered, one.covered);
    EXPECT_GT(rmse(one.radiance, many.radiance), 1e-4);  // the edges of the checks are smoothed
    EXPECT_LT(rmse(one.radiance, many.radiance), 0.2);
}

// Glass without absorption is invisible where light comes alike from everywhere. A path that is caught
// inside and cut after so many vertices is missing, and counted.
TEST_F(References, PathTracedGlassVanishesInUniformLight) {
    set_up("shape:goblet", uniform_environment(glm::vec3(0.25f, 0.5f, 1.0f)));
    RenderSettings settings = settings_for("path");
    settings.samples = 4;
    const RenderResult result = renderer().render(settings);
    ASSERT_EQ(result.standard_error.width, int(kSize));
    std::uint64_t darker = 0;
    for (std::uint32_t i = 0; i < kSize * kSize; ++i) {
        const glm::vec3 radiance = rgb(result.radiance, int(i % kSize), int(i / kSize));
        const glm::vec3 error = glm::abs(radiance - glm::vec3(0.25f, 0.5f, 1.0f));
        if (std::max({error.x, error.y, error.z}) <= 1e-3f) continue;
        ++darker;
        EXPECT_NEAR(radiance.z, 0.75f, 1e-3f);  // one path of four
    }
    EXPECT_EQ(darker, result.cut_paths);
    EXPECT_LT(darker, 10u);
}

TEST_F(References, PathTracingHasTheCountsOfTheReference) {
    set_up("shape:sphere", sky());
    RenderSettings settings = settings_for("reference");
    const RenderResult exact = renderer().render(settings);
    EXPECT_TRUE(exact.standard_error.pixels.empty());
    settings.technique = "path";
    settings.samples = 8;
    const RenderResult traced = renderer().render(settings);
    EXPECT_EQ(traced.covered, exact.covered);
    EXPECT_EQ(traced.status, exact.status);
    EXPECT_TRUE(all_finite(traced.radiance));
    // The same picture but for noise, the light reflected inside, and the smoothed edge.
    EXPECT_LT(rmse(exact.display, traced.display), 0.1);
    EXPECT_GT(rmse(exact.display, traced.display), 1e-4);
}

// What the tracer was asked once is built anew for another scene.
TEST_F(References, FollowTheScene) {
    RenderSettings settings = settings_for("reference");
    set_up("shape:sphere", sky());
    const std::uint64_t sphere = renderer().render(settings).covered;
    set_up("shape:torus", sky());
    const std::uint64_t torus = renderer().render(settings).covered;
    set_up("shape:sphere", sky());
    EXPECT_EQ(renderer().render(settings).covered, sphere);
    EXPECT_NE(torus, sphere);
    renderer().set_scene(Scene{});
    EXPECT_EQ(renderer().render(settings).covered, 0u);
}

TEST_F(References, AnalysisViewOfThePathTechniqueShowsTheExactEvents) {
    set_up("shape:torus", sky());
    RenderSettings settings = settings_for("reference");
    settings.view = View::kAnalysis;
    const RenderResult exact = renderer().render(settings);
    settings.technique = "path";
    EXPECT_EQ(renderer().render(settings).display.pixels, exact.display.pixels);
}

}  // namespace
}  // namespace pellucid::test
