// The environment as shaders see it, against the CPU, and its orientation in pictures.
#include "gpu/gpu_test.h"

#include <array>
#include <random>

namespace pellucid::test {
namespace {

Environment environment_of(Environment::Kind kind) {
    Environment environment;
    environment.kind = kind;
    return environment;
}

Environment noise_map(int width, int height) {
    Environment environment;
    environment.kind = Environment::Kind::kMap;
    environment.map = Image(width, height, 3);
    std::mt19937 generator(7);
    std::uniform_real_distribution<float> uniform(0.0f, 10.0f);
    for (float& value : environment.map.pixels) value = uniform(generator);
    return environment;
}

Environment placed(Environment environment, float rotation, float intensity) {
    environment.rotation = rotation;
    environment.intensity = intensity;
    return environment;
}

Camera turned(float yaw, float pitch) {
    Camera camera;
    camera.vertical_fov = 1.2f;
    camera.world_from_view =
        glm::rotate(glm::mat4(1.0f), yaw, glm::vec3(0, 1, 0)) * glm::rotate(glm::mat4(1.0f), pitch, glm::vec3(1, 0, 0));
    return camera;
}

class EnvironmentTest : public RendererTest {
protected:
    Image background(const Environment& environment, const Camera& camera, std::uint32_t size) {
        renderer().set_environment(environment);
        renderer().set_camera(camera);
        RenderSettings settings;
        settings.width = settings.height = size;
        return renderer().render(settings).radiance;
    }
};

TEST_F(EnvironmentTest, BackgroundAgreesWithTheCpu) {
    constexpr int kSize = 48;
    const std::array<std::pair<const char*, Environment>, 7> environments = {{
        {"studio", environment_of(Environment::Kind::kStudio)},
        {"checker", environment_of(Environment::Kind::kChecker)},
        {"sky", environment_of(Environment::Kind::kSky)},
        {"uniform", uniform_environment({0.1f, 0.2f, 0.3f})},
        {"map", noise_map(31, 17)},
        {"turned map", placed(noise_map(31, 17), 2.0f, 0.5f)},
        {"turned sky", placed(environment_of(Environment::Kind::kSky), -0.7f, 3.0f)},
    }};
    for (const auto& [name, environment] : environments) {
        int differing = 0, pixels = 0;
        for (const glm::vec2 turn :
             {glm::vec2(0.0f, 0.0f), glm::vec2(1.6f, 0.5f), glm::vec2(3.0f, -1.4f), glm::vec2(-1.5f, 1.5f)}) {
            const Camera camera = turned(turn.x, turn.y);
            const Image image = background(environment, camera, kSize);
            for (int y = 0; y < kSize; ++y) {
                for (int x = 0; x < kSize; ++x) {
                    const glm::vec3 expected =
                        radiance(environment, glm::vec3(pixel_ray(camera, kSize, kSize, x, y).direction));
                    const float scale = 1.0f + glm::length(expected);
                    ++pixels;
                    differing += glm::distance(rgb(image, x, y), expected) > 2e-3f * scale ? 1 : 0;
                }
            }
        }
        // Edges of checks and grid lines fall to one side or the other by rounding.
        EXPECT_LE(differing, pixels / 200) << name;
    }
}

// Red above, blue below; a green mark, 45 degrees wide, around column `mark` of 64. +X is column 32,
// the centre; -Z is column 16.
Environment oriented_map(int mark) {
    Environment environment;
    environment.kind = Environment::Kind::kMap;
    environment.map = Image(64, 32, 3);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 64; ++x) {
            float* texel = environment.map.at(x, y);
            texel[0] = y < 16 ? 1.0f : 0.0f;
            texel[2] = y < 16 ? 0.0f : 1.0f;
            texel[1] = std::abs(x - mark) < 4 ? 1.0f : 0.0f;
        }
    }
    return environment;
}

TEST_F(EnvironmentTest, IsNotMirrored) {
    constexpr int kSize = 64;
    // Looking along -Z, +X is to the right: the green mark must show when turning right by 90 degrees.
    const Image ahead = background(oriented_map(32), turned(0.0f, 0.0f), kSize);
    EXPECT_LT(rgb(ahead, 32, 20).g, 0.1f);
    EXPECT_GT(rgb(ahead, 32, 10).r, 0.9f);  // up is the top of the map
    EXPECT_GT(rgb(ahead, 32, 54).b, 0.9f);
    EXPECT_GT(rgb(background(oriented_map(32), turned(-kPi / 2, 0.0f), kSize), 32, 20).g, 0.9f);
    EXPECT_LT(rgb(background(oriented_map(32), turned(kPi / 2, 0.0f), kSize), 32, 20).g, 0.1f);
}

/// Glass, a matt floor and metal of several roughnesses.
Scene still_life() {
    Scene scene = load_scene("shape:knot");
    const Scene ball = load_scene("shape:sphere,segments=64");
    const auto add = [&](float metallic, float roughness, const glm::mat4& placement) {
        Material material;
        material.base_color = {0.8f, 0.7f, 0.6f, 1.0f};
        material.metallic = metallic;
        material.roughness = roughness;
        scene.objects.push_back({"", int(scene.meshes.size()), int(scene.materials.size()), placement});
        scene.materials.push_back(material);
        scene.meshes.push_back(ball.meshes[0]);
    };
    for (int i = 0; i < 4; ++i)
        add(i < 3 ? 1.0f : 0.0f, i < 3 ? 0.3f * float(i) : 1.0f,
            glm::scale(glm::translate(glm::mat4(1.0f), glm::vec3(-1.5f + float(i), -1.2f, 1.0f)), glm::vec3(0.4f)));
    return scene;
}

class PlacedEnvironment : public TechniqueTest {
protected:
    static constexpr int kSize = 64;

    Image draw(const Environment& environment, float turn) {
        Scene scene = still_life();
        const glm::mat4 world = glm::rotate(glm::mat4(1.0f), turn, glm::vec3(0, 1, 0));
        Camera camera = orbit_camera(scene_bounds(scene), 20.0f, 10.0f, framing_distance(0.5f, 0.7f), 0.5f);
        camera.world_from_view = world * camera.world_from_view;
        for (Object& object : scene.objects) object.world_from_object = world * object.world_from_object;
        renderer().set_scene(scene);
        renderer().set_camera(camera);
        renderer().set_environment(environment);
        RenderSettings settings;
        settings.width = settings.height = kSize;
        settings.technique = GetParam();
        return renderer().render(settings).radiance;
    }
    static double mean_difference(const Image& a, const Image& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::abs(double(a.pixels[i]) - double(b.pixels[i]));
        return sum / double(a.pixels.size());
    }
};

INSTANTIATE_TEST_SUITE_P(Techniques, PlacedEnvironment,
                         ::testing::Values("visibility-layers", "kay-greenberg-1979", "wyman-2005"),
                         technique_test_name);

TEST_P(PlacedEnvironment, IsTheSceneTurnedTheOtherWay) {
    for (const Environment& environment : {environment_of(Environment::Kind::kStudio), noise_map(31, 17)}) {
        const float level = environment.kind == Environment::Kind::kMap ? 5.0f : 0.3f;  // its mean radiance, about
        const Image still = draw(environment, 0.0f), expected = draw(environment, -2.3f);
        const Image found = draw(placed(environment, 2.3f, 1.0f), 0.0f);
        // Paths that graze an edge go elsewhere by rounding.
        EXPECT_LT(mean_difference(found, expected), 0.02 * double(level));
        EXPECT_GT(mean_difference(found, still), 0.2 * double(level));
    }
}

TEST_P(PlacedEnvironment, IntensityIsAFactor) {
    const Environment environment = noise_map(31, 17);
    const Image one = draw(environment, 0.0f), third = draw(placed(environment, 0.0f, 1.0f / 3.0f), 0.0f);
    for (std::size_t i = 0; i < one.pixels.size(); ++i)
        EXPECT_NEAR(one.pixels[i], 3.0f * third.pixels[i], 1e-3f * (1.0f + one.pixels[i]));
}

// A ball lens turns the world upside down and left to right.
TEST_F(EnvironmentTest, SolidSphereShowsItUpsideDown) {
    constexpr int kSize = 128;
    renderer().set_scene(load_scene("shape:sphere"));
    const float fov = 0.5235988f;
    const Bounds bounds{glm::vec3(0.0f), 1.0f};
    // Looking along -Z with the mark 45 degrees to the right, so that it appears on the ball's left.
    const Image image =
        background(oriented_map(24), orbit_camera(bounds, 0.0f, 0.0f, framing_distance(fov, 0.7f), fov), kSize);
    EXPECT_GT(rgb(image, 64, 10).r, 0.9f);  // above the ball
    EXPECT_GT(rgb(image, 64, 64 - 25).b, 3.0f * rgb(image, 64, 64 - 25).r);
    EXPECT_GT(rgb(image, 64, 64 + 25).r, 3.0f * rgb(image, 64, 64 + 25).b);

    float left = 0.0f, right = 0.0f;
    for (int x = 0; x < 64; ++x) {
        left += rgb(image, x, 64).g;
        right += rgb(image, 127 - x, 64).g;
    }
    // Refraction shows the mark on the left; the right has it in the faint outer reflection only.
    EXPECT_GT(left, 2.0f * right);
    EXPECT_GT(left, 5.0f);
}

}  // namespace
}  // namespace pellucid::test
