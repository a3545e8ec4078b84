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
    const std::array<std::pair<const char*, Environment>, 5> environments = {{
        {"studio", environment_of(Environment::Kind::kStudio)},
        {"checker", environment_of(Environment::Kind::kChecker)},
        {"sky", environment_of(Environment::Kind::kSky)},
        {"uniform", uniform_environment({0.1f, 0.2f, 0.3f})},
        {"map", noise_map(31, 17)},
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
