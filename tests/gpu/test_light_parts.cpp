// The parts of a frame's light as AOVs: emitted, direct, caustic and indirect.
#include "closed_form/lights.h"
#include "gpu/gpu_test.h"
#include "gpu/mean_color.h"
#include "unit/built_scenes.h"

#include <glm/gtc/matrix_transform.hpp>

#include <numbers>

namespace pellucid::test {
namespace {

constexpr int kSize = 32;

Material grey(float albedo, float emission = 0.0f) {
    Material material;
    material.base_color = glm::vec4(glm::vec3(albedo), 1.0f);
    material.roughness = 1.0f;
    material.ior = 1.0f;  // no coat: all that the surface reflects is diffuse
    material.emission = glm::vec3(emission);
    return material;
}

Material metal(float roughness) {
    Material material;
    material.metallic = 1.0f;
    material.roughness = roughness;
    material.base_color = {0.9f, 0.7f, 0.4f, 1.0f};
    return material;
}

glm::mat4 upward_at(glm::vec3 middle, float half_side) {
    const glm::mat4 moved = glm::translate(glm::mat4(1.0f), middle);
    return glm::scale(glm::rotate(moved, -0.5f * std::numbers::pi_v<float>, {1, 0, 0}), glm::vec3(half_side));
}

glm::mat4 ball_at(glm::vec3 middle, float radius) {
    return glm::scale(glm::translate(glm::mat4(1.0f), middle), glm::vec3(radius));
}

/// A ball of glass on a grey floor.
Scene ball_on_floor() {
    Scene scene = scene_of(load_scene("shape:sphere,segments=64").meshes[0]);
    add(scene, square(), grey(0.5f), upward_at({0, -1.05f, 0}, 4.0f));
    return scene;
}

/// All that sends, bends and scatters light.
Scene of_everything() {
    Scene scene = ball_on_floor();
    const Mesh sphere = scene.meshes[0];
    add(scene, sphere, metal(0.0f), ball_at({1.6f, -0.5f, -0.4f}, 0.5f));
    add(scene, sphere, metal(0.2f), ball_at({-1.6f, -0.5f, -0.4f}, 0.5f));
    add(scene, square(), grey(0.3f, 2.0f), glm::translate(glm::mat4(1.0f), {0.0f, 0.3f, -2.0f}));
    Material rough = glass();
    rough.roughness = 0.3f;
    add(scene, sphere, rough, ball_at({0.9f, -0.7f, 1.2f}, 0.3f));
    Material pane = glass();
    pane.thickness = 0.0f;
    add(scene, square(), pane, ball_at({-0.9f, -0.6f, 1.3f}, 0.4f));
    scene.lights = {sun({0.4f, -1.0f, -0.3f}, 1.0f), lamp({-1.5f, 2.0f, 1.0f}, 3.0f, 0.1f)};
    scene.lights[0].angular_diameter = 0.1f;
    return scene;
}

class LightParts : public TechniqueTest {
protected:
    void SetUp() override {
        TechniqueTest::SetUp();
        if (IsSkipped()) return;
        settings_.width = settings_.height = kSize;
        settings_.technique = GetParam();
        settings_.aovs = {kLightParts.begin(), kLightParts.end()};
    }
    void set(const Scene& scene, float environment, const Camera& camera) {
        renderer().set_scene(scene);
        renderer().set_environment(uniform_environment(glm::vec3(environment)));
        renderer().set_camera(camera);
    }
    static Camera above(float distance) {
        Bounds bounds;
        bounds.half_size = glm::vec3(1.0f);
        bounds.radius = 1.0f;
        return orbit_camera(bounds, 15.0f, 35.0f, distance, Camera{}.vertical_fov);
    }
    RenderSettings settings_;
};

TEST_P(LightParts, AddUpToThePicture) {
    set(of_everything(), 0.3f, above(6.0f));
    for (const LightTransport transport : {LightTransport::kEnvironment, LightTransport::kFull}) {
        SCOPED_TRACE(int(transport));
        settings_.light.transport = transport;
        settings_.samples = transport == LightTransport::kFull ? 2 : 1;
        const RenderResult drawn = renderer().render(settings_);
        for (std::size_t i = 0; i < drawn.radiance.pixels.size(); ++i) {
            double sum = 0.0;
            for (const auto& [name, image] : drawn.aovs) sum += double(image.pixels[i]);
            // Panes are drawn in 16-bit floats.
            const double value = double(drawn.radiance.pixels[i]);
            ASSERT_NEAR(sum, value, 2e-3 * std::abs(value) + 2e-3) << i;
        }
        RenderSettings alone = settings_;
        alone.aovs.clear();
        const RenderResult same = renderer().render(alone);
        EXPECT_EQ(same.radiance.pixels, drawn.radiance.pixels);
        EXPECT_EQ(same.display.pixels, drawn.display.pixels);
    }
}

class LightPartsByPaths : public LightParts {};

// Walls of albedo 1/2 that emit 1/2: light has met none, one, or more of them when it is seen.
TEST_P(LightPartsByPaths, AGlowingRoomSendsEveryPart) {
    Scene cube = load_scene("shape:cube");
    const Bounds bounds = scene_bounds(cube);
    for (glm::vec3& p : cube.meshes[0].positions) p = (p - bounds.center) / bounds.half_size;
    const Scene room = scene_of(with_flat_normals(inside_out(cube.meshes[0])), grey(0.5f, 0.5f));
    set(room, 0.0f, Camera{});
    settings_.light.transport = LightTransport::kFull;
    settings_.samples = 40;  // rays look at the cache behind one bounce, which is 1% short by then
    const RenderResult drawn = renderer().render(settings_);
    EXPECT_NEAR(mean_color(drawn.aovs.at("emitted")).g, 0.5, 1e-5);
    EXPECT_NEAR(mean_color(drawn.aovs.at("direct")).g, 0.25, 0.005);
    EXPECT_NEAR(mean_color(drawn.aovs.at("indirect")).g, 0.25, 0.01);
    EXPECT_EQ(mean_color(drawn.aovs.at("caustic")).g, 0.0);
}

// Against the path tracer, which tells the parts apart by its own walk.
TEST_P(LightPartsByPaths, AreThoseOfThePathTracer) {
    Scene scene = ball_on_floor();
    scene.lights = {sun({0.4f, -1.0f, -0.3f}, 2.0f)};
    scene.lights[0].angular_diameter = 0.2f;
    add(scene, square(), grey(0.6f), glm::translate(glm::mat4(1.0f), {0.0f, 0.0f, -1.5f}));
    set(scene, 0.2f, above(5.0f));
    settings_.light.transport = LightTransport::kFull;
    settings_.samples = 32;
    const RenderResult drawn = renderer().render(settings_);
    settings_.technique = "path";
    settings_.parameters.clear();
    settings_.samples = 256;
    const RenderResult traced = renderer().render(settings_);
    for (const std::string_view part : kLightParts) {
        const std::string name(part);
        SCOPED_TRACE(name);
        const double expected = mean_color(traced.aovs.at(name)).g;
        // Of the sun's image in the ball, a few pixels, 32 samples know 10%.
        EXPECT_NEAR(mean_color(drawn.aovs.at(name)).g, expected, (part == "emitted" ? 0.1 : 0.03) * expected + 0.001);
    }
}

TEST_P(LightPartsByPaths, NoOtherViewHasThem) {
    settings_.view = View::kAnalysis;
    EXPECT_THROW(renderer().render(settings_), Error);
}

INSTANTIATE_TEST_SUITE_P(Techniques, LightParts,
                         ::testing::Values("visibility-layers", "visibility-cube", "ray-tracing-cpu", "ray-tracing",
                                           "wang-2014", "wyman-2005", "kay-greenberg-1979", "one-interface",
                                           "reference"),
                         technique_test_name);
INSTANTIATE_TEST_SUITE_P(Paths, LightPartsByPaths,
                         ::testing::Values("visibility-layers", "ray-tracing-cpu", "ray-tracing"), technique_test_name);

}  // namespace
}  // namespace pellucid::test
