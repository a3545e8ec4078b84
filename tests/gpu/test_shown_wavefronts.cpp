// Wavefronts of light as View::kWavefront shows them.
#include "gpu/gpu_test.h"
#include "gpu/wavefront_test.h"

#include <pellucid/error.h>

#include <numbers>

namespace pellucid::test {
namespace {

class ShownWavefront : public Wavefront {
protected:
    /// What is kept of the wavefronts at this spacing, voxels.
    std::vector<gpu::ShownPatch> shown(const Scene& scene, float spacing, std::uint32_t capacity = 1u << 18) {
        LightSettings settings;
        settings.shown_spacing = spacing;
        settings.capacity = capacity;
        trace(scene, settings);
        const Buffer& source = tracer().light().shown;
        const Buffer& copy = workspace().buffer("copy of wavefronts", source.size(), true);
        recorder().copy(source, copy, source.size());
        recorder().submit_and_wait();
        std::vector<gpu::ShownPatch> patches = read_back<gpu::ShownPatch>(copy);
        EXPECT_EQ(patches.size(), 4u * capacity);
        patches.resize(tracer().statistics().shown);
        return patches;
    }
};

glm::dvec3 middle(const gpu::ShownPatch& patch) {
    glm::dvec3 sum(0.0);
    for (const glm::vec4& corner : patch.position) sum += 0.25 * glm::dvec3(corner);
    return sum;
}

// Light begins a voxel before the box. From there on a wavefront every 8 voxels, plane and as bright as the sun.
TEST_F(ShownWavefront, IsPlaneInAnEvenBox) {
    Scene scene;
    place(scene, block(32, 1.0f, 1.0f, glm::vec3(0.0f)));
    scene.lights = {directional({0.0f, -1.0f, 0.0f}, {0.5f, 1.0f, 2.0f})};
    int of_front[4] = {};
    for (const gpu::ShownPatch& patch : shown(scene, 8.0f)) {
        const double voxels = (0.5 - middle(patch).y) * 32.0 + 1.0;
        const int front = int(std::lround(voxels / 8.0));
        ASSERT_GE(front, 1);
        ASSERT_LE(front, 4);
        ++of_front[front - 1];
        for (const glm::vec4& corner : patch.position)
            EXPECT_NEAR((0.5 - double(corner.y)) * 32.0 + 1.0, 8.0 * front, 1e-3);
        EXPECT_LT(patch.position[1].w, 1.001f);  // less where only a part of a patch meets the box
        EXPECT_GT(patch.position[1].w, 0.1f);
        EXPECT_NEAR(patch.position[2].w, 2.0f * patch.position[1].w, 1e-3f);
    }
    const int side = 34;  // patches of 0.95 voxel across 32 voxels
    for (const int count : of_front) EXPECT_EQ(count, side * side);
    EXPECT_EQ(tracer().statistics().not_shown, 0u);
    EXPECT_TRUE(tracer().statistics().warnings().empty());

    // Of eight wavefronts four find room.
    shown(scene, 4.0f, std::uint32_t(side * side));
    EXPECT_EQ(tracer().statistics().shown, std::uint32_t(4 * side * side));
    EXPECT_EQ(tracer().statistics().not_shown, std::uint32_t(4 * side * side));
    const std::vector<std::string> warnings = tracer().statistics().warnings();
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("are not shown"), std::string::npos) << warnings[0];
}

// All ways from a plane through a Luneburg lens to its focus have one optical length, (1 + pi / 2) radii from the plane that
// touches it on. What lies 8 voxels before is a part of the sphere around the focus, where the index is nearly 1.
TEST_F(ShownWavefront, ClosesAroundTheFocusOfALuneburgLens) {
    Scene scene;
    place(scene, make_volume("luneburg,resolution=96,radius=1"));
    scene.lights = {directional({0.0f, -1.0f, 0.0f})};
    const double voxel = double(scene.volumes[0]->voxel), before = 8.0;
    const double way = (double(scene.volumes[0]->high().y) + 0.5 * std::numbers::pi) / voxel + 1.0;
    double sum = 0.0, worst = 0.0;
    int count = 0;
    for (const gpu::ShownPatch& patch : shown(scene, float(way - before))) {
        if (patch.position[0].w < 4.0f) continue;  // beside the lens
        const double off = glm::distance(middle(patch), glm::dvec3(0.0, -1.0, 0.0)) / voxel;
        sum += off;
        worst = std::max(worst, std::abs(off - before));
        ++count;
    }
    std::printf("wavefront %.1f voxels before the focus: %d patches, %.3f on the mean, %.3f off at most\n", before,
                count, sum / count, worst);
    EXPECT_GT(count, 3000);
    EXPECT_NEAR(sum / count, before, 0.5);
    EXPECT_LT(worst, 2.0);
}

class WavefrontView : public RendererTest {
protected:
    RenderSettings settings_ = [] {
        RenderSettings settings;
        settings.width = settings.height = 64;
        settings.technique = "ihrke-2007";
        settings.view = View::kWavefront;
        return settings;
    }();
};

// A sun of 1 W/m2 from the camera on: white sheets before the box, which exposure turns orange.
TEST_F(WavefrontView, ColorsWavefrontsByTheirIrradiance) {
    Scene scene;
    place(scene, block(32, 1.0f, 1.0f, glm::vec3(0.0f)));
    scene.lights = {directional({0.0f, 0.0f, -1.0f})};
    Camera camera;
    camera.world_from_view = glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.0f, 4.0f));
    renderer().set_scene(scene);
    renderer().set_camera(camera);
    renderer().set_environment(uniform_environment());
    const RenderResult white = renderer().render(settings_);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(rgb(white.radiance, 32, 32)[c], 0.7f, 0.02f);  // the sheets face the camera
        EXPECT_NEAR(rgb(white.radiance, 2, 2)[c], 0.25f, 0.01f);   // the environment, dimmed
    }
    settings_.exposure_ev = 2.0f;
    const glm::vec3 orange = rgb(renderer().render(settings_).radiance, 32, 32);
    EXPECT_NEAR(orange.r, 0.75f, 0.02f);
    EXPECT_NEAR(orange.g, 0.28f, 0.02f);
    EXPECT_NEAR(orange.b, 0.02f, 0.02f);
    settings_.exposure_ev = -5.0f;  // too faint
    EXPECT_LT(rgb(renderer().render(settings_).radiance, 32, 32).r, 0.01f);
    settings_.exposure_ev = 0.0f;
    settings_.view = View::kRadiance;
    EXPECT_NEAR(rgb(renderer().render(settings_).radiance, 32, 32).r, 1.0f, 0.01f);
}

TEST_F(WavefrontView, SaysWhatItLacks) {
    Scene scene;
    place(scene, block(16, 1.0f, 1.0f, glm::vec3(0.0f)));
    renderer().set_scene(scene);
    const auto message = [&] {
        try {
            renderer().render(settings_);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(message(), "view wavefront: the scene has no lights");
    scene.lights = {directional({0.0f, 0.0f, -1.0f})};
    scene.volumes.clear();
    scene.volume_objects.clear();
    renderer().set_scene(scene);
    EXPECT_EQ(message(), "view wavefront: the scene has no volumes");
    settings_.technique = "wang-2014";
    EXPECT_EQ(message(), "view wavefront: wang-2014 traces no wavefronts of light; ihrke-2007 does");
}

}  // namespace
}  // namespace pellucid::test
