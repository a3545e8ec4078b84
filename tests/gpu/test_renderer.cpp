// The renderer as a whole: sizes, repetition, samples, names, recovery.
#include "gpu/gpu_test.h"
#include "unit/built_scenes.h"
#include "unit/test_files.h"

#include <gmock/gmock.h>

#include <unistd.h>
#include <fstream>

namespace pellucid::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

RenderSettings sized(std::uint32_t width, std::uint32_t height) {
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    return settings;
}

using RendererSuite = RendererTest;

TEST_F(RendererSuite, AnySizeInAnyOrder) {
    renderer().set_scene(load_scene("shape:torus"));
    for (const auto& [width, height] :
         {std::pair{17u, 13u}, {1u, 1u}, {4001u, 3u}, {3u, 1501u}, {64u, 64u}, {17u, 13u}}) {
        for (const LayerBuilder builder : {LayerBuilder::kSinglePass, LayerBuilder::kCompute,
                                           LayerBuilder::kDepthPeeling, LayerBuilder::kDualDepthPeeling}) {
            RenderSettings settings = sized(width, height);
            settings.layer_builder = builder;
            settings.aovs = aovs_of_paths();
            const RenderResult result = renderer().render(settings);
            EXPECT_EQ(result.display.width, int(width));
            EXPECT_EQ(result.display.height, int(height));
            EXPECT_TRUE(all_finite(result.radiance));
            for (const auto& [name, image] : result.aovs) EXPECT_TRUE(all_finite(image)) << name;
        }
    }
}

TEST_F(RendererSuite, SettingsOutOfRangeAreRefusedAndTheNextFrameWorks) {
    renderer().set_scene(load_scene("shape:sphere,segments=8"));
    const auto refuse = [&](RenderSettings settings, const char* text) {
        EXPECT_THAT([&] { renderer().render(settings); }, ThrowsMessage<Error>(HasSubstr(text)));
        EXPECT_GT(renderer().render(sized(16, 16)).covered, 50u);
    };
    refuse(sized(0, 16), "size 0x16");
    refuse(sized(16, 2000000), "size 16x2000000: pictures have");
    refuse(sized(1000000, 1000000), "size 1000000x1000000: the picture takes");
    RenderSettings settings = sized(16, 16);
    settings.technique = "magic";
    refuse(settings, "known: fast, balanced, exact, one-interface, ");
    settings = sized(16, 16);
    settings.technique = "wang-2014";
    settings.parameters["speed"] = 1;
    refuse(settings, "it has: layers, steps");
    settings.parameters = {{"layers", 1e9}};
    refuse(settings, "layers must be");
    settings.parameters = {{"steps", 1.5}};
    refuse(settings, "whole number");
    settings.parameters = {{"steps", std::nan("")}};
    refuse(settings, "steps must be");
    settings = sized(16, 16);
    settings.samples = 0;
    refuse(settings, "samples");
    settings = sized(16, 16);
    settings.aovs = {"colour"};
    refuse(settings, "known: exit-direction");
    settings = sized(16, 16);
    settings.exposure_ev = std::nanf("");
    refuse(settings, "exposure");
}

TEST_F(RendererSuite, SameFrameTwiceIsTheSameBitForBit) {
    renderer().set_scene(load_scene("shape:goblet"));
    renderer().set_environment(load_environment("sky"));
    for (const TechniqueInfo* technique : techniques()) {
        if (!renderer().lacking(*technique).empty()) continue;
        RenderSettings settings = sized(128, 96);
        settings.technique = technique->name;
        settings.samples = 3;
        settings.aovs = aovs_of_paths();
        const RenderResult first = renderer().render(settings);
        const RenderResult second = renderer().render(settings);
        EXPECT_EQ(first.radiance.pixels, second.radiance.pixels) << technique->name;
        EXPECT_EQ(first.display.pixels, second.display.pixels) << technique->name;
        for (const auto& [name, image] : first.aovs) EXPECT_EQ(image.pixels, second.aovs.at(name).pixels) << name;
    }
}

TEST_F(RendererSuite, EveryPixelHasAStatusAndNoNanWhateverTheMesh) {
    std::vector<std::string> scenes = {"shape:gem", "shape:knot", "shape:hollow-sphere", "shape:cube", "shape:slab"};
    if (!data_folder().empty()) {
        // Open, non-manifold and inverted meshes.
        for (const char* model :
             {"teapot.obj", "suzanne.obj", "f16.ply", "dragon_vrip_res3.ply", "horse.ply", "stanford-bunny.obj"}) {
            scenes.push_back(data_folder() / "models" / model);
        }
    }
    for (const std::string& scene : scenes) {
        renderer().set_scene(load_scene(scene));
        for (const TechniqueInfo* technique : techniques()) {
            if (!renderer().lacking(*technique).empty()) continue;
            RenderSettings settings = sized(96, 96);
            settings.technique = technique->name;
            settings.aovs = aovs_of_paths();
            const RenderResult result = renderer().render(settings);
            EXPECT_GT(result.covered, 100u) << scene;
            std::uint64_t with_status = 0;
            for (const std::uint64_t count : result.status) with_status += count;
            EXPECT_EQ(with_status, result.covered) << scene;
            EXPECT_TRUE(all_finite(result.radiance)) << scene << " " << technique->name;
            for (const auto& [name, image] : result.aovs) EXPECT_TRUE(all_finite(image)) << scene << " " << name;
            const Image& direction = result.aovs.at("exit-direction");
            for (std::size_t i = 0; i < direction.pixels.size(); i += 3) {
                ASSERT_NEAR(
                    glm::length(glm::vec3(direction.pixels[i], direction.pixels[i + 1], direction.pixels[i + 2])), 1.0f,
                    1e-4f);
            }
        }
    }
}

TEST_F(RendererSuite, SamplesConvergeAndAovsStay) {
    renderer().set_scene(load_scene("shape:sphere"));
    renderer().set_environment(load_environment("checker"));
    RenderSettings settings = sized(48, 48);
    settings.aovs = aovs_of_paths();
    const RenderResult one = renderer().render(settings);
    EXPECT_EQ(one.frames.size(), 1u);
    settings.samples = 64;
    const RenderResult many = renderer().render(settings);
    settings.samples = 128;
    const RenderResult more = renderer().render(settings);
    EXPECT_EQ(many.frames.size(), 64u);
    EXPECT_EQ(one.aovs.at("exit-direction").pixels, many.aovs.at("exit-direction").pixels);
    EXPECT_EQ(one.covered, many.covered);
    const auto rms = [](const Image& a, const Image& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
            sum += std::pow(double(a.pixels[i]) - double(b.pixels[i]), 2.0);
        return std::sqrt(sum / double(a.pixels.size()));
    };
    EXPECT_LT(rms(many.radiance, more.radiance), 0.3 * rms(one.radiance, more.radiance));
}

TEST_F(RendererSuite, AllLayerBuildersDrawTheSamePicture) {
    renderer().set_scene(load_scene("shape:infinity-ring"));
    for (const std::uint32_t samples : {1u, 3u}) {
        RenderSettings settings = sized(200, 150);
        settings.technique = "wang-2014";
        settings.samples = samples;
        settings.layer_builder = LayerBuilder::kSinglePass;
        const RenderResult single = renderer().render(settings);
        EXPECT_EQ(single.layer_passes, 1u);
        for (const char* builder : {"depth-peeling", "dual-depth-peeling"}) {
            settings.layer_builder = parse_layer_builder(builder);
            const RenderResult result = renderer().render(settings);
            EXPECT_EQ(single.radiance.pixels, result.radiance.pixels) << builder;
            EXPECT_GT(result.layer_passes, 1u) << builder;
            EXPECT_EQ(result.warnings, single.warnings) << builder << " is not the builder that was asked for";
        }
    }
}

TEST_F(RendererSuite, PresetsStandForTechniquesOfTheDevice) {
    ASSERT_EQ(presets().size(), 3u);
    EXPECT_EQ(presets()[1].name, RenderSettings{}.technique);
    renderer().set_scene(load_scene("shape:goblet,segments=24"));
    for (const PresetInfo& preset : presets()) {
        const TechniqueChoice choice = renderer().choose(preset.name);
        EXPECT_TRUE(renderer().lacking(*choice.technique).empty()) << preset.name;
        RenderSettings settings = sized(64, 64);
        settings.samples = 2;
        settings.technique = preset.name;
        const RenderResult by_preset = renderer().render(settings);
        settings.technique = choice.technique->name;
        settings.parameters = choice.parameters;
        EXPECT_EQ(renderer().render(settings).radiance.pixels, by_preset.radiance.pixels) << preset.name;
    }
    // What the caller gives goes first.
    RenderSettings settings = sized(64, 64);
    settings.technique = "exact";
    settings.parameters = {{"events", 2.0}};
    const std::uint64_t cut = renderer().render(settings).status[std::size_t(Status::kEventLimit)];
    EXPECT_GT(cut, 100u);
    EXPECT_EQ(renderer().choose("wang-2014").technique->name, "wang-2014");
}

TEST_F(RendererSuite, LayerBuildersHaveNames) {
    EXPECT_EQ(parse_layer_builder("automatic"), LayerBuilder::kAutomatic);
    EXPECT_EQ(parse_layer_builder("single-pass"), LayerBuilder::kSinglePass);
    EXPECT_EQ(parse_layer_builder("compute"), LayerBuilder::kCompute);
    EXPECT_EQ(parse_layer_builder("depth-peeling"), LayerBuilder::kDepthPeeling);
    EXPECT_EQ(parse_layer_builder("dual-depth-peeling"), LayerBuilder::kDualDepthPeeling);
    EXPECT_THAT(
        [] { parse_layer_builder("dual"); },
        ThrowsMessage<Error>(HasSubstr("known: automatic, single-pass, compute, depth-peeling, dual-depth-peeling")));
}

TEST_F(RendererSuite, PassTimesAreThere) {
    renderer().set_scene(load_scene("shape:sphere"));
    const RenderResult result = renderer().render(sized(64, 64));
    if (result.frames.front().empty()) GTEST_SKIP() << "the queue has no timestamps";
    std::vector<std::string> names;
    for (const PassTime& pass : result.frames.front()) {
        names.push_back(pass.name);
        EXPECT_GE(pass.time_ms, 0.0);
    }
    EXPECT_THAT(names, ::testing::IsSupersetOf({"layers", "trace", "shade"}));
}

TEST_F(RendererSuite, AnalysisViewColoursTheInterfaces) {
    renderer().set_scene(load_scene("shape:sphere"));
    RenderSettings settings = sized(32, 32);
    settings.view = View::kAnalysis;
    const glm::vec3 center = rgb(renderer().render(settings).radiance, 16, 16);
    EXPECT_GT(center.r, 4.0f * center.b);  // two interfaces: red
    renderer().set_scene(load_scene("shape:hollow-sphere"));
    const glm::vec3 hollow = rgb(renderer().render(settings).radiance, 16, 16);
    EXPECT_GT(hollow.b, 4.0f * hollow.r);  // four: blue
}

// Without refraction in a uniform environment every sample is exactly 1, and so is their mean, also
// where the fragment pool overflows in the middle: hollow shells fill it with more than it begins with.
TEST_F(RendererSuite, OverflowingFramesCountOnce) {
    LoadOptions options;
    options.ior = 1.0f;
    const Scene scene = load_scene("shape:hollow-sphere", options);
    renderer().set_scene(scene);
    renderer().set_environment(uniform_environment());
    RenderSettings settings = sized(48, 48);
    settings.samples = 32;
    for (float distance = 4.30f; distance < 4.36f; distance += 0.005f) {  // around the pool's first size
        renderer().set_camera(orbit_camera(scene_bounds(scene), 0.0f, 0.0f, distance, Camera{}.vertical_fov));
        renderer().set_scene(scene);
        for (const float value : renderer().render(settings).radiance.pixels)
            ASSERT_NEAR(value, 1.0f, 1e-4f) << distance;
    }
}

TEST_F(RendererSuite, WhatIsBuiltByHandIsChecked) {
    const Scene good = load_scene("shape:cube");
    renderer().set_scene(good);
    const auto refuse = [&](auto spoil, const char* text) {
        Scene bad = good;
        spoil(bad);
        EXPECT_THAT([&] { renderer().set_scene(bad); }, ThrowsMessage<Error>(HasSubstr(text)));
        EXPECT_GT(renderer().render(sized(16, 16)).covered, 20u);  // the scene before is still there
    };
    refuse([](Scene& s) { s.meshes[0].normals.clear(); }, "one finite normal per position");
    refuse([](Scene& s) { s.meshes[0].triangles[0].x = 1000; }, "vertex that is not there");
    refuse([](Scene& s) { s.meshes[0].positions[0].x = std::nanf(""); }, "not finite");
    refuse([](Scene& s) { s.meshes[0].texcoords[0].resize(1); }, "texture coordinates");
    refuse([](Scene& s) { s.objects[0].mesh = 7; }, "no such mesh");
    refuse([](Scene& s) { s.objects[0].material = -1; }, "no such material");
    refuse([](Scene& s) { s.objects[0].world_from_object[0] = glm::vec4(0.0f); }, "invertible");
    refuse([](Scene& s) { s.materials[0].base_color_texture.image = 0; }, "image that is not there");
    refuse([](Scene& s) { s.materials[0].ior = 0.5f; }, "index of refraction");
    refuse([](Scene& s) { s.materials[0].dispersion = -1.0f; }, "dispersion");
    refuse([](Scene& s) { s.images.resize(1); }, "one name per image");

    Environment map;
    map.kind = Environment::Kind::kMap;
    EXPECT_THAT([&] { renderer().set_environment(map); }, ThrowsMessage<Error>(HasSubstr("3 channels")));
    Camera camera;
    camera.orthographic = true;
    EXPECT_THAT([&] { renderer().set_camera(camera); }, ThrowsMessage<Error>(HasSubstr("vertical extent")));
    camera = Camera{};
    camera.vertical_fov = 4.0f;
    EXPECT_THAT([&] { renderer().set_camera(camera); }, ThrowsMessage<Error>(HasSubstr("field of view")));
    camera = Camera{};
    camera.near_plane = 2.0f;
    camera.far_plane = 1.0f;
    EXPECT_THAT([&] { renderer().set_camera(camera); }, ThrowsMessage<Error>(HasSubstr("far plane")));
    EXPECT_GT(renderer().render(sized(16, 16)).covered, 20u);
}

TEST_F(RendererSuite, BadStatusesAreCountedInOneWarning) {
    renderer().set_scene(load_scene("shape:sphere,segments=8"));
    RenderSettings settings = sized(16, 16);
    settings.technique = "visibility-layers";
    settings.parameters = {{"events", 1.0}};  // no path gets out of the sphere
    const RenderResult cut = renderer().render(settings);
    ASSERT_EQ(cut.warnings.size(), 1u);
    EXPECT_THAT(cut.warnings[0], AllOf(HasSubstr(std::to_string(cut.covered) + " glass pixels"),
                                       HasSubstr("event_limit"), HasSubstr("visibility-layers")));
}

TEST_F(RendererSuite, ApproximationsAreSaid) {
    Scene scene = load_scene("shape:sphere,segments=8");
    renderer().set_scene(scene);
    EXPECT_THAT(renderer().render(sized(8, 8)).warnings, ::testing::IsEmpty());
    scene.materials[0].name = "frosted";
    scene.materials[0].roughness = 0.3f;
    scene.materials[0].dispersion = 1.0f;
    scene.materials.emplace_back();
    scene.objects.push_back(scene.objects[0]);
    scene.objects.push_back(scene.objects[0]);
    scene.objects.back().material = 1;
    renderer().set_scene(scene);
    RenderSettings settings = sized(8, 8);
    settings.technique = "one-interface";
    EXPECT_THAT(renderer().render(settings).warnings,
                ::testing::ElementsAre(HasSubstr("frosted: dispersion"), HasSubstr("frosted: rough glass"),
                                       HasSubstr("2 refracting objects"), HasSubstr("opaque objects")));
    // Techniques are not blamed for what they do draw.
    for (const char* technique : {"wang-2014", "reference"}) {
        settings.technique = technique;
        EXPECT_THAT(renderer().render(settings).warnings,
                    ::testing::ElementsAre(HasSubstr("frosted: dispersion"), HasSubstr("frosted: rough glass"),
                                           HasSubstr("opaque objects")));
    }
    settings.technique = "path";
    EXPECT_THAT(renderer().render(settings).warnings, ::testing::IsEmpty());
}

// Techniques that do not count what a ray is inside of say so where it matters.
TEST_F(RendererSuite, SolidsThatAreNotCountedAreSaid) {
    Mesh mesh = cube();
    const Mesh other = cube(1.0f, {0.5f, 0.5f, 0.5f});
    for (const glm::uvec3 t : other.triangles) mesh.triangles.push_back(t + unsigned(mesh.positions.size()));
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    renderer().set_scene(scene_of(with_flat_normals(mesh)));
    RenderSettings settings = sized(8, 8);
    for (const char* technique : {"wang-2014", "wyman-2005"}) {
        settings.technique = technique;
        EXPECT_THAT(renderer().render(settings).warnings, ::testing::Contains(HasSubstr("a solid of shells")));
    }
    settings.technique = "visibility-layers";
    EXPECT_THAT(renderer().render(settings).warnings, ::testing::IsEmpty());
    Camera inside;
    inside.world_from_view[3] = glm::vec4(0.25f, 0.25f, 0.25f, 1.0f);
    renderer().set_camera(inside);
    EXPECT_THAT(renderer().render(settings).warnings, ::testing::IsEmpty());
    settings.technique = "wang-2014";
    EXPECT_THAT(renderer().render(settings).warnings, ::testing::Contains(HasSubstr("may be inside a solid")));
}

long resident_kilobytes() {
    long pages = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

TEST_F(RendererSuite, HundredsOfFramesDoNotGrow) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the address sanitizer keeps freed memory";
#endif
    const Scene scene = load_scene("shape:torus,segments=24,sides=12");
    renderer().set_scene(scene);
    long after_warm_up = 0;
    for (int frame = 0; frame < 400; ++frame) {
        renderer().render(sized(24 + frame % 3, 24));  // resizing all the time
        if (frame % 50 == 0) renderer().set_scene(scene);
        if (frame == 100) after_warm_up = resident_kilobytes();
    }
    // The validation layer keeps some state per object that was ever made.
    EXPECT_LT(resident_kilobytes() - after_warm_up, 40 * 1024);
}

TEST(RendererDevice, UnknownDeviceListsTheKnown) {
    try {
        list_devices();
    } catch (const DeviceError& error) {
        GTEST_SKIP() << error.what();
    }
    EXPECT_THAT([] { Renderer({.device = "no such device", .validation = false}); },
                ThrowsMessage<Error>(HasSubstr("found: 0 (")));
    EXPECT_THAT([] { Renderer({.device = "99", .validation = false}); },
                ThrowsMessage<Error>(HasSubstr("unknown device '99'")));
}

}  // namespace
}  // namespace pellucid::test
