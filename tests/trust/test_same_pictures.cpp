// The same picture bit for bit: over runs, numbers of threads, order of scenes, and renderers in other threads.
#include "gpu/gpu_test.h"

#include <thread>

namespace pellucid::test {
namespace {

constexpr std::array kScenes = {"shape:goblet", "shape:knot", "shape:gem", "shape:torus"};

RenderSettings small(std::string_view technique) {
    RenderSettings settings;
    settings.width = 48;
    settings.height = 40;
    settings.technique = technique;
    settings.samples = 2;
    return settings;
}

/// Glass over a floor under a lamp, so that photons and bounces have work.
Scene lit_scene(const std::string& source) {
    Scene scene = load_scene(source);
    const Bounds bounds = scene_bounds(scene);
    Scene floor = load_scene("shape:cube");
    Material grey;
    grey.transmission = 0.0f;
    Object object = floor.objects.front();
    object.mesh = int(scene.meshes.size());
    object.material = int(scene.materials.size());
    object.body = -1;
    glm::mat4 placed(1.0f);
    placed[3] = glm::vec4(bounds.center - glm::vec3(0.0f, 3.0f * bounds.radius, 0.0f), 1.0f);
    object.world_from_object = placed * object.world_from_object;
    scene.meshes.push_back(floor.meshes.front());
    scene.materials.push_back(grey);
    scene.objects.push_back(object);
    Light lamp;
    lamp.intensity = glm::vec3(20.0f);
    lamp.position = bounds.center + bounds.radius * glm::vec3(1.0f, 3.0f, 1.0f);
    lamp.radius = 0.1f * bounds.radius;
    scene.lights.push_back(lamp);
    return scene;
}

class SamePictures : public TechniqueTest {};

TEST_P(SamePictures, InAnyOrderOfScenes) {
    std::vector<Scene> scenes;
    for (const char* source : kScenes) scenes.push_back(lit_scene(source));
    std::vector<std::vector<float>> alone;
    for (const Scene& scene : scenes) {
        Renderer fresh({.device = {}, .validation = true});
        fresh.set_scene(scene);
        alone.push_back(fresh.render(small(GetParam())).radiance.pixels);
        expect_silent(fresh.validation_messages());
    }
    for (const std::size_t i : {3u, 0u, 2u, 0u, 1u, 1u}) {
        renderer().set_scene(scenes[i]);
        RenderSettings other = small(GetParam());
        other.width = 30 + std::uint32_t(i);
        renderer().render(other);
        renderer().set_scene(scenes[i]);
        EXPECT_EQ(renderer().render(small(GetParam())).radiance.pixels, alone[i]) << kScenes[i];
    }
}

TEST_P(SamePictures, OnAnyNumberOfThreads) {
    const Scene scene = lit_scene("shape:goblet");
    std::optional<RenderResult> first;
    for (const std::uint32_t threads : {1u, 2u, 5u}) {
        Renderer fresh({.device = {}, .validation = true, .threads = threads});
        fresh.set_scene(scene);
        RenderSettings settings = small(GetParam());
        settings.paths = true;
        RenderResult result = fresh.render(settings);
        if (first) {
            EXPECT_EQ(result.radiance.pixels, first->radiance.pixels) << threads;
            EXPECT_TRUE(same_paths(result.paths, first->paths)) << threads;
        }
        if (!first) first = std::move(result);
    }
}

std::vector<const char*> technique_names() {
    std::vector<const char*> names;
    for (const TechniqueInfo* technique : techniques()) names.push_back(technique->name.data());
    return names;
}
INSTANTIATE_TEST_SUITE_P(Each, SamePictures, ::testing::ValuesIn(technique_names()), technique_test_name);

TEST(TwoRenderers, InTwoThreadsDrawWhatEachDrawsAlone) {
    const auto draw = [](const std::string& source, int rounds) {
        Renderer renderer({.device = {}, .validation = true});
        renderer.set_scene(load_scene(source));
        std::vector<std::vector<float>> pictures;
        for (int round = 0; round < rounds; ++round) {
            for (const char* technique : {"wang-2014", "visibility-layers", "reference"})
                pictures.push_back(renderer.render(small(technique)).radiance.pixels);
        }
        expect_silent(renderer.validation_messages());
        return pictures;
    };
    std::vector<std::vector<float>> gem, knot;
    try {
        gem = draw("shape:gem", 3);
        knot = draw("shape:knot", 3);
    } catch (const DeviceError& error) {
        GTEST_SKIP() << error.what();
    }
    std::vector<std::vector<float>> gem_beside, knot_beside;
    std::thread one([&] { gem_beside = draw("shape:gem", 3); });
    std::thread other([&] { knot_beside = draw("shape:knot", 3); });
    one.join();
    other.join();
    EXPECT_EQ(gem_beside, gem);
    EXPECT_EQ(knot_beside, knot);
}

}  // namespace
}  // namespace pellucid::test
