// The cache of irradiance that stands for bounces in frames, against closed forms.
#include "gpu/gpu_test.h"

#include <glm/gtc/matrix_transform.hpp>

namespace pellucid::test {
namespace {

constexpr int kSize = 48;
constexpr float kHalf = 1.0f;  // of the room's side, m

/// A closed room of boxes, with a box on its floor, seen from its middle.
class IrradianceCache : public TechniqueTest {
protected:
    Scene room(const Material& material) const {
        const Scene box = load_scene("shape:cube");
        const Bounds bounds = scene_bounds(box);
        Scene scene;
        scene.meshes = box.meshes;
        scene.materials = {material};
        const auto add = [&](const glm::vec3& low, const glm::vec3& high) {
            Object object;
            object.mesh = 0;
            object.material = 0;
            const glm::mat4 moved = glm::translate(glm::mat4(1.0f), 0.5f * (low + high));
            object.world_from_object =
                glm::translate(glm::scale(moved, 0.5f * (high - low) / bounds.half_size), -bounds.center);
            scene.objects.push_back(object);
        };
        for (int axis = 0; axis < 3; ++axis) {
            for (const float side : {-1.0f, 1.0f}) {
                glm::vec3 low(-1.1f * kHalf), high(1.1f * kHalf);
                (side < 0.0f ? high : low)[axis] = side * kHalf;
                add(low, high);
            }
        }
        add({-0.6f, -kHalf, -0.8f}, {-0.1f, -0.4f, -0.3f});
        return scene;
    }
    RenderResult draw(const Scene& scene, float environment, std::uint32_t samples) {
        renderer().set_scene(scene);
        renderer().set_environment(uniform_environment(glm::vec3(environment)));
        Camera camera;
        camera.vertical_fov = 1.4f;
        renderer().set_camera(camera);
        RenderSettings settings;
        settings.width = settings.height = kSize;
        settings.technique = GetParam();
        settings.samples = samples;
        settings.light.transport = LightTransport::kFull;
        return renderer().render(settings);
    }
    static double mean(const RenderResult& drawn) {
        double sum = 0.0;
        for (const float value : drawn.radiance.pixels) sum += double(value);
        return sum / double(drawn.radiance.pixels.size());
    }
};

Material grey(float emission) {
    Material material;
    material.base_color = glm::vec4(glm::vec3(0.5f), 1.0f);
    material.roughness = 1.0f;
    material.ior = 1.0f;  // no coat: all that the surface reflects is diffuse
    material.emission = glm::vec3(emission);
    return material;
}

// Walls of albedo 1/2 that emit 1/2 have the radiance 1/2 + 1/4 + 1/8 + ... = 1. The cache learns the later terms frame by frame:
// after 16 samples 4% are missing, after 40, whose rays look at it behind one bounce, 1%. Without surfaces that the eye does not
// see, 10% are.
TEST_P(IrradianceCache, HoldsAllBouncesOfARoomThatGlows) {
    EXPECT_NEAR(mean(draw(room(grey(0.5f)), 0.0f, 16)), 1.0, 0.05);
    EXPECT_NEAR(mean(draw(room(grey(0.5f)), 0.0f, 40)), 1.0, 0.02);
}

// No light of the environment comes into a closed room. The first frame does not know that of surfaces behind two bounces: an
// eighth of 1, of 16 samples 0.8%. The cache knows that nothing is open, so rays take off little, and make little noise.
TEST_P(IrradianceCache, AClosedRoomIsDark) {
    const RenderResult drawn = draw(room(grey(0.0f)), 1.0f, 16);
    EXPECT_NEAR(mean(drawn), 0.0, 0.015);
    double squares = 0.0;
    for (const float value : drawn.radiance.pixels) squares += double(value) * double(value);
    EXPECT_LT(std::sqrt(squares / double(drawn.radiance.pixels.size())), 0.03);
}

TEST_P(IrradianceCache, TwoRunsAreEqual) {
    const RenderResult first = draw(room(grey(0.5f)), 0.3f, 4), second = draw(room(grey(0.5f)), 0.3f, 4);
    EXPECT_EQ(first.radiance.pixels, second.radiance.pixels);
}

INSTANTIATE_TEST_SUITE_P(Techniques, IrradianceCache,
                         ::testing::Values("visibility-layers", "ray-tracing-cpu", "ray-tracing", "wang-2014"),
                         technique_test_name);

}  // namespace
}  // namespace pellucid::test
