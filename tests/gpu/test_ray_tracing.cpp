// The technique ray-tracing against analytic answers and against itself. What it has in common with other finders is tested
// with them (Finders, EveryFinder, Arrangements).
#include "gpu/exact_sphere.h"

#include <gmock/gmock.h>

#include <string>

namespace pellucid::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kIor = 1.5;

RenderSettings settings_for(std::uint32_t size) {
    RenderSettings settings;
    settings.width = settings.height = size;
    settings.technique = "ray-tracing";
    settings.aovs = {"exit-direction", "exit-position", "path-length", "events", "status"};
    return settings;
}

Camera framing(const Scene& scene, float azimuth_deg, float elevation_deg = 15.0f) {
    const float fov = 0.5235988f;
    return orbit_camera(scene_bounds(scene), azimuth_deg, elevation_deg, framing_distance(fov, 0.7f), fov);
}

bool has_glass(const RenderResult& result, int x, int y) { return rgb(result.aovs.at("events"), x, y).x > 0.0f; }

glm::dvec3 exit_direction(const RenderResult& result, int x, int y) {
    return glm::dvec3(rgb(result.aovs.at("exit-direction"), x, y));
}

class RayTracing : public RendererTest {
protected:
    void SetUp() override {
        RendererTest::SetUp();
        if (IsSkipped()) return;
        const std::string lacking = renderer().lacking(find_technique("ray-tracing"));
        if (!lacking.empty()) GTEST_SKIP() << renderer().device().name << " lacks " << lacking;
    }
    RenderResult render(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
        renderer().set_scene(scene);
        renderer().set_camera(camera);
        renderer().set_environment(uniform_environment());
        return renderer().render(settings);
    }
};

TEST_F(RayTracing, SphereExitsWhereTheFormulaSays) {
    constexpr int kSize = 256;
    const Scene scene = load_scene("shape:sphere,segments=160");  // facets do not matter
    const Camera camera = framing(scene, 30.0f);
    const RenderResult result = render(scene, camera, settings_for(kSize));
    int covered = 0, right = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            if (!has_glass(result, x, y)) continue;
            const auto exact = through_unit_sphere(pixel_ray(camera, kSize, kSize, x, y), kIor);
            if (!exact) continue;  // the pixel's ray misses the sphere that the mesh stands for
            ++covered;
            if (angle_deg(exit_direction(result, x, y), exact->direction) > 1.0) continue;
            ++right;
            EXPECT_LT(glm::distance(glm::dvec3(rgb(result.aovs.at("exit-position"), x, y)), exact->position), 0.01);
            EXPECT_NEAR(*result.aovs.at("path-length").at(x, y), exact->length, 0.01);
        }
    }
    EXPECT_GT(covered, 22000);
    EXPECT_GE(double(right) / covered, 0.999);
}

/// Two slabs, one behind the other: the same mesh twice, with an index and an absorption each.
Scene two_slabs(double ior_in_front, double ior_behind, glm::vec3 tint_behind) {
    Scene scene = load_scene("shape:slab,width=4,height=4,thickness=0.3");
    scene.materials.push_back(scene.materials[0]);
    scene.materials[0].ior = float(ior_in_front);
    scene.materials[1].ior = float(ior_behind);
    scene.materials[1].attenuation_color = tint_behind;
    scene.materials[1].attenuation_distance = 0.3f;
    scene.objects.push_back(scene.objects[0]);
    scene.objects[1].material = 1;
    scene.objects[1].world_from_object =
        glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, -1)) * scene.objects[0].world_from_object;
    return scene;
}

// Each plane-parallel slab shifts the ray sideways by t sin(i) (1 - cos(i) / sqrt(n^2 - sin^2(i))).
TEST_F(RayTracing, EveryObjectHasItsOwnMaterial) {
    const double angle = 0.6, thickness = 0.3, ior_in_front = 1.3, ior_behind = 1.8;
    Camera camera;
    camera.orthographic = true;
    camera.vertical_extent = 0.2f;
    camera.world_from_view = glm::rotate(glm::mat4(1.0f), float(angle), glm::vec3(0, 1, 0)) *
                             glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, 10));
    const glm::vec3 tint(0.2f, 0.5f, 0.9f);
    const RenderResult result = render(two_slabs(ior_in_front, ior_behind, tint), camera, settings_for(33));

    const glm::dvec3 direction = -glm::dvec3(camera.world_from_view[2]);
    EXPECT_EQ(rgb(result.aovs.at("events"), 16, 16), glm::vec3(4, 0, 0));
    EXPECT_LT(angle_deg(exit_direction(result, 16, 16), direction), 0.01);
    const double s = std::sin(angle);
    double shift = 0.0;
    for (const double ior : {ior_in_front, ior_behind}) {
        shift += thickness * s * (1.0 - std::cos(angle) / std::sqrt(ior * ior - s * s));
    }
    const glm::dvec3 exit(rgb(result.aovs.at("exit-position"), 16, 16));
    EXPECT_NEAR(glm::length(glm::cross(exit, direction)), shift, 1e-5);
    // Fresnel's losses are the same for every colour; absorption is in the second slab alone.
    const double path = 1.0 / std::sqrt(1.0 - s * s / (ior_behind * ior_behind));  // in units of the thickness
    const double reflected = fresnel_dielectric(std::cos(angle), 1.0 / ior_in_front);
    const glm::dvec3 transmitted = glm::dvec3(rgb(result.radiance, 16, 16)) - reflected;
    EXPECT_NEAR(transmitted.r / transmitted.b, std::pow(double(tint.r) / double(tint.b), path), 1e-4);
}

double time_of(const RenderResult& result, std::string_view pass) {
    double sum = 0.0;
    for (const PassTime& time : result.frames.back()) sum += time.name == pass ? time.time_ms : 0.0;
    return sum;
}

TEST_F(RayTracing, HierarchyIsKeptRefittedOrRebuilt) {
    const Scene scene = load_scene("shape:knot");
    renderer().set_camera(framing(scene, 0.0f));
    renderer().set_scene(scene);
    const bool timed = !renderer().render(settings_for(96)).frames.back().empty();
    const auto render_with = [&](double rebuild) {
        RenderSettings settings = settings_for(96);
        settings.parameters["rebuild"] = rebuild;
        return renderer().render(settings);
    };
    const RenderResult kept = render_with(0);
    EXPECT_EQ(time_of(kept, "build"), 0.0);  // built by the frame before
    EXPECT_GT(kept.covered, 1500u);
    EXPECT_EQ(kept.status[std::size_t(Status::kOk)] + kept.status[std::size_t(Status::kEventLimit)], kept.covered);
    for (const double rebuild : {1.0, 2.0}) {
        for (int frame = 0; frame < 3; ++frame) {
            const RenderResult result = render_with(rebuild);
            EXPECT_EQ(result.radiance.pixels, kept.radiance.pixels) << "rebuild " << rebuild << ", frame " << frame;
            const bool refit = rebuild == 1.0 && frame > 0;
            EXPECT_EQ(time_of(result, refit ? "refit" : "build") > 0.0, timed) << rebuild << ", frame " << frame;
        }
    }
}

// The first move makes the hierarchy one that can be refitted.
TEST_F(RayTracing, WhatMovesIsRefitted) {
    Scene scene = load_scene("shape:knot");
    renderer().set_scene(scene);
    renderer().set_camera(framing(scene, 0.0f));
    const bool timed = !renderer().render(settings_for(96)).frames.back().empty();
    for (const char* pass : {"build", "refit", "refit"}) {
        for (glm::vec3& p : scene.meshes[0].positions) p.x *= 1.1f;
        renderer().set_positions({{0, scene.meshes[0].positions, scene.meshes[0].normals}});
        const RenderResult moved = renderer().render(settings_for(96));
        EXPECT_EQ(time_of(moved, pass) > 0.0, timed);
        const RenderResult kept = renderer().render(settings_for(96));
        EXPECT_EQ(time_of(kept, "build") + time_of(kept, "refit"), 0.0);
        EXPECT_EQ(kept.radiance.pixels, moved.radiance.pixels);
    }
}

TEST_F(RayTracing, RunsAreEqualAndScenesDoNotMix) {
    const Scene knot = load_scene("shape:knot");
    const Scene goblet = load_scene("shape:goblet");
    const RenderResult first = render(knot, framing(knot, 0.0f), settings_for(96));
    const RenderResult between = render(goblet, framing(goblet, 0.0f), settings_for(96));
    const RenderResult again = render(knot, framing(knot, 0.0f), settings_for(96));
    EXPECT_EQ(first.radiance.pixels, again.radiance.pixels);
    for (const auto& [name, image] : first.aovs) EXPECT_EQ(image.pixels, again.aovs.at(name).pixels) << name;
    Renderer other;
    other.set_scene(goblet);
    other.set_camera(framing(goblet, 0.0f));
    other.set_environment(uniform_environment());
    EXPECT_EQ(between.radiance.pixels, other.render(settings_for(96)).radiance.pixels);
    const RenderResult empty = render(Scene{}, Camera{}, settings_for(96));
    EXPECT_EQ(empty.covered, 0u);
    for (const float value : empty.radiance.pixels) ASSERT_EQ(value, 1.0f);
}

TEST_F(RayTracing, StatusSaysWhatIsMissing) {
    const Scene sphere = load_scene("shape:sphere");
    RenderSettings settings = settings_for(64);
    const auto all_are = [&](Status status) {
        const RenderResult result = renderer().render(settings);
        EXPECT_GT(result.covered, 500u);
        EXPECT_EQ(result.status[std::size_t(status)], result.covered) << status_name(status);
    };
    render(sphere, framing(sphere, 0.0f), settings);
    settings.parameters["events"] = 2;
    all_are(Status::kOk);
    settings.parameters["events"] = 1;
    all_are(Status::kEventLimit);

    Scene open = load_scene("shape:slab,width=4,height=4");
    Mesh& mesh = open.meshes[0];
    std::erase_if(mesh.triangles, [&](glm::uvec3 t) { return mesh.normals[t.x].z < 0.5f; });  // its front alone
    settings.parameters.clear();
    render(open, framing(open, 0.0f), settings);
    all_are(Status::kMissingLayer);
}

class WithoutRayTracing : public RendererTest {};

TEST_F(WithoutRayTracing, TheTechniqueIsRefusedAndOthersWork) {
    const DeviceInfo& device = renderer().device();
    if (renderer().lacking(find_technique("ray-tracing")).empty()) GTEST_SKIP() << device.name << " traces rays";
    EXPECT_THAT(device.absent, Contains(HasSubstr("ray tracing")));
    renderer().set_scene(load_scene("shape:sphere,segments=8"));
    RenderSettings settings = settings_for(32);
    EXPECT_THAT([&] { renderer().render(settings); },
                ThrowsMessage<DeviceError>(
                    AllOf(HasSubstr("ray-tracing"), HasSubstr(device.name), HasSubstr("VK_KHR_ray_query"))));
    settings.technique = "one-interface";
    EXPECT_GT(renderer().render(settings).covered, 100u);
}

}  // namespace
}  // namespace pellucid::test
