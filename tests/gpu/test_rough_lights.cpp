// Light of lights at rough glass in frames, against closed forms and the path tracer.
#include "closed_form/lights.h"
#include "gpu/gpu_test.h"
#include "gpu/mean_color.h"
#include "unit/built_scenes.h"

#include <glm/gtc/matrix_transform.hpp>

namespace pellucid::test {
namespace {

constexpr int kSize = 48;

Material rough_glass(float roughness, float ior = 1.5f) {
    Material material = glass(ior);
    material.roughness = roughness;
    return material;
}

/// A box around the origin, as large as `half_size` says, m.
Mesh box(glm::vec3 half_size) {
    const Scene cube = load_scene("shape:cube");
    const Bounds bounds = scene_bounds(cube);
    Mesh mesh = cube.meshes[0];
    for (glm::vec3& p : mesh.positions) p = half_size * (p - bounds.center) / bounds.half_size;
    return with_flat_normals(mesh);
}
Mesh ball() { return load_scene("shape:sphere,segments=64").meshes[0]; }

Light disc(glm::vec3 direction, float irradiance, float degrees) {
    Light light = sun(direction, irradiance);
    light.angular_diameter = glm::radians(degrees);
    return light;
}

class RoughLights : public TechniqueTest {
protected:
    void SetUp() override {
        TechniqueTest::SetUp();
        if (IsSkipped()) return;
        settings_.width = settings_.height = kSize;
        settings_.light.transport = LightTransport::kDirect;
        look_from(3.0f);
    }
    void look_from(float distance, float elevation = 35.0f) {
        Bounds bounds;
        bounds.half_size = glm::vec3(1.0f);
        bounds.radius = 1.0f;
        camera_ = orbit_camera(bounds, 15.0f, elevation, distance, Camera{}.vertical_fov);
    }
    void set(const Scene& scene) {
        renderer().set_scene(scene);
        renderer().set_environment(uniform_environment(glm::vec3(environment_)));
        renderer().set_camera(camera_);
    }
    RenderResult draw(std::string technique, std::uint32_t samples) {
        // The walk inside of glass is long: the 17th surface still has 1% of the light.
        // Frames of several samples take one way each, like `path`, so that no light goes on with another way's.
        settings_.parameters.clear();
        if (technique != "path") settings_.parameters = {{"events", 64.0}, {"one-branch", samples > 1 ? 1.0 : 0.0}};
        settings_.technique = std::move(technique);
        settings_.samples = samples;
        return renderer().render(settings_);
    }
    /// Mean radiance of the frame beside that of `path`, within `share` of it.
    void expect_that_of_path(const Scene& scene, std::uint32_t samples, std::uint32_t path_samples,
                             double share = 0.02) {
        set(scene);
        const glm::dvec3 found = mean_color(draw(GetParam(), samples).radiance);
        const glm::dvec3 expected = mean_color(draw("path", path_samples).radiance);
        EXPECT_GT(expected.g, 0.0);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], share * expected[c]) << "channel " << c;
    }

    RenderSettings settings_;
    Camera camera_;
    float environment_ = 0.0f;
};

// Two suns that fill the sky shine on a ball. It sends out what it gets, so it looks like the sky: E / (2 pi).
TEST_P(RoughLights, ABallIsUnseenBetweenTwoSuns) {
    for (const float roughness : {0.3f, 0.8f}) {
        SCOPED_TRACE(roughness);
        Scene scene = scene_of(ball(), rough_glass(roughness));
        for (const float side : {1.0f, -1.0f}) scene.lights.push_back(disc({0.0f, side, 0.2f}, 2.0f, 179.99f));
        scene.lights[1].direction = -scene.lights[0].direction;
        set(scene);
        const double sky = 2.0 / (2.0 * double(kPi));
        EXPECT_NEAR(mean_color(draw(GetParam(), 16).radiance).g, sky, 0.003 * sky);
    }
}

// From above, what a plate reflects; from below, what it lets pass.
TEST_P(RoughLights, PlatesAreThoseOfThePathTracer) {
    Scene scene = scene_of(box({1.0f, 0.1f, 1.0f}), rough_glass(0.9f));
    for (const float side : {1.0f, -1.0f})
        for (const float radius : {0.0f, 0.3f}) {
            SCOPED_TRACE(testing::Message() << "side " << side << ", radius " << radius);
            scene.lights = {lamp({0.2f, 1.5f * side, -1.0f}, 3.0f, radius)};
            expect_that_of_path(scene, 32, 256, 0.03);
        }
}

// A lamp inside of a ball, whose light is understood as seen from outside.
TEST_P(RoughLights, LampsMayBeInside) {
    Scene scene = scene_of(ball(), rough_glass(0.6f));
    for (const float radius : {0.0f, 0.2f}) {
        SCOPED_TRACE(radius);
        scene.lights = {lamp({0.3f, 0.2f, 0.1f}, 1.0f, radius)};
        expect_that_of_path(scene, 16, 256);
    }
}

// A bright plate beside a rough one.
TEST_P(RoughLights, EmissiveSurfacesAreSeen) {
    Scene scene = scene_of(box({1.0f, 0.1f, 1.0f}), rough_glass(0.6f));
    Material bright;
    bright.base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
    bright.ior = 1.0f;
    bright.emission = glm::vec3(3.0f, 2.0f, 1.0f);
    add(scene, square(), bright, glm::translate(glm::mat4(1.0f), {0.0f, 1.2f, -1.0f}));
    expect_that_of_path(scene, 16, 256);
}

// Such a small one is met by chance too seldom: shadow rays aim at it.
TEST_P(RoughLights, SmallEmissiveSurfacesAreAimedAt) {
    Scene scene = scene_of(box({1.0f, 0.1f, 1.0f}), rough_glass(0.6f));
    Material bright;
    bright.base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
    bright.ior = 1.0f;
    bright.emission = glm::vec3(3000.0f, 2000.0f, 1000.0f);
    add(scene, square(), bright, glm::mat4(1.0f));
    for (const float side : {1.0f, -1.0f}) {
        SCOPED_TRACE(side);
        const glm::mat4 aside = glm::translate(glm::mat4(1.0f), {0.3f, 1.5f * side, -2.5f});
        scene.objects.back().world_from_object = glm::scale(aside, glm::vec3(0.02f));
        expect_that_of_path(scene, 32, 256, 0.03);
    }
}

// One refraction is `indirect` behind the first rough surface, and its reflection `direct`.
TEST_P(RoughLights, PartsAreThoseOfThePathTracer) {
    Scene scene = scene_of(box({1.0f, 0.1f, 1.0f}), rough_glass(0.6f));
    scene.lights = {disc({-0.2f, -1.0f, 0.6f}, 2.0f, 20.0f)};
    set(scene);
    settings_.aovs = {kLightParts.begin(), kLightParts.end()};
    const RenderResult drawn = draw(GetParam(), 32), traced = draw("path", 256);
    for (const std::string_view part : kLightParts) {
        const std::string name(part);
        SCOPED_TRACE(name);
        const double expected = mean_color(traced.aovs.at(name)).g;
        EXPECT_NEAR(mean_color(drawn.aovs.at(name)).g, expected, 0.03 * expected + 1e-5);
    }
}

// Frames of one sample have the highlight of the first surface. A lobe stands for the facets of those behind, which pass a little
// more light, since nothing is reflected inside.
TEST_P(RoughLights, OneSampleShowsHighlights) {
    Scene scene = scene_of(box({1.0f, 0.1f, 1.0f}), rough_glass(0.6f));
    settings_.aovs = {"direct", "indirect"};
    for (const float side : {1.0f, -1.0f}) {
        const char* const part = side > 0.0f ? "direct" : "indirect";
        SCOPED_TRACE(part);
        scene.lights = {lamp({0.2f, 1.5f * side, -1.0f}, 3.0f)};
        set(scene);
        const double found = mean_color(draw(GetParam(), 1).aovs.at(part)).g;
        const double expected = mean_color(draw("path", 256).aovs.at(part)).g;
        EXPECT_NEAR(found, expected, (side > 0.0f ? 0.05 : 0.3) * expected);
    }
    settings_.aovs.clear();
    // A lamp without light changes nothing.
    environment_ = 1.0f;
    set(scene);
    settings_.light.transport = LightTransport::kEnvironment;
    const Image without = draw(GetParam(), 1).radiance;
    scene.lights = {lamp({0.2f, 1.5f, -1.0f}, 1e-9f)};
    set(scene);
    settings_.light.transport = LightTransport::kDirect;
    const Image with = draw(GetParam(), 1).radiance;
    for (std::size_t i = 0; i < with.pixels.size(); ++i) ASSERT_NEAR(with.pixels[i], without.pixels[i], 1e-6f) << i;
}

// Glass throws a caustic on a floor that sends a part of its light to its other side. The ball, and a mirror, show it, too.
TEST_P(RoughLights, TranslucentFloorsShowCaustics) {
    Scene scene = scene_of(ball());
    Material floor;
    floor.base_color = {0.8f, 0.6f, 0.4f, 1.0f};
    floor.ior = 1.0f;
    floor.roughness = 1.0f;
    floor.thickness = 1.0f;
    floor.diffuse_transmission = 0.4f;
    Material mirror;
    mirror.metallic = 1.0f;
    mirror.roughness = 0.0f;
    const glm::mat4 upward = glm::rotate(glm::mat4(1.0f), -glm::radians(90.0f), {1, 0, 0});
    const glm::mat4 below = glm::translate(glm::mat4(1.0f), {0.0f, -1.5f, 0.0f});
    add(scene, square(), floor, glm::scale(below * upward, glm::vec3(2.0f)));
    add(scene, square(), mirror, glm::translate(glm::mat4(1.0f), {0.0f, 0.0f, -2.0f}));
    scene.lights = {sun({0.2f, -1.0f, -0.1f}, 3.0f)};
    look_from(6.0f);
    set(scene);
    settings_.light.transport = LightTransport::kFull;
    settings_.aovs = {"caustic"};
    const glm::dvec3 found = mean_color(draw(GetParam(), 16).aovs.at("caustic"));
    const glm::dvec3 expected = mean_color(draw("path", 64).aovs.at("caustic"));
    EXPECT_GT(expected.g, 0.0);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 0.05 * expected[c]) << "channel " << c;
}

INSTANTIATE_TEST_SUITE_P(Techniques, RoughLights, ::testing::Values("visibility-layers", "ray-tracing-cpu"),
                         technique_test_name);

}  // namespace
}  // namespace pellucid::test
