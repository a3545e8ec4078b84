// wang-2014 on scenes of several solids (section 3.7 of the thesis).
#include "gpu/gpu_test.h"

#include <algorithm>

namespace pellucid::test {
namespace {

constexpr std::uint32_t kSize = 160;

struct Placed {
    const char* shape;
    glm::vec3 position;
    float scale = 1.0f;
};

/// Solids of one glass of index 1.5.
Scene scene_of(const std::vector<Placed>& solids) {
    Scene scene;
    for (const Placed& solid : solids) {
        Scene loaded = load_scene(solid.shape);
        Object object = loaded.objects.front();
        object.mesh = int(scene.meshes.size());
        object.material = 0;
        object.world_from_object = glm::scale(glm::translate(glm::mat4(1.0f), solid.position), glm::vec3(solid.scale));
        scene.meshes.push_back(std::move(loaded.meshes.front()));
        scene.objects.push_back(std::move(object));
        if (scene.materials.empty()) scene.materials.push_back(loaded.materials.front());
    }
    return scene;
}

class ManyObjects : public RendererTest {
protected:
    RenderResult render(const Scene& scene, const Camera& camera, const char* technique = "wang-2014",
                        LayerBuilder builder = LayerBuilder::kSinglePass) {
        renderer().set_scene(scene);
        renderer().set_environment(uniform_environment());
        renderer().set_camera(camera);
        RenderSettings settings;
        settings.width = settings.height = kSize;
        settings.technique = technique;
        settings.layer_builder = builder;
        settings.paths = true;
        return renderer().render(settings);
    }
};

Camera front_camera(const Scene& scene) {
    return orbit_camera(scene_bounds(scene), 0.0f, 0.0f, framing_distance(0.5236f, 0.8f), 0.5236f);
}

constexpr const char* kSlab = "shape:slab,width=2,height=2,thickness=0.3";

// Parallel plates bend no ray: after each the direction is the old one, and the glass crossed adds up.
TEST_F(ManyObjects, PlatesInARowAddUp) {
    for (const int count : {2, 3, 5}) {
        std::vector<Placed> plates;
        for (int i = 0; i < count; ++i) plates.push_back({kSlab, glm::vec3(0.0f, 0.0f, -0.8f * float(i))});
        const Scene scene = scene_of(plates);
        Camera camera;
        camera.orthographic = true;
        camera.vertical_extent = 0.4f;
        const float angle = 0.3f;
        camera.world_from_view = glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0, 1, 0)) *
                                 glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, 10));
        const RenderResult result = render(scene, camera);
        const RefractedPath& path = result.paths[kSize / 2 * kSize + kSize / 2];
        EXPECT_EQ(path.events, 2 * count);
        EXPECT_EQ(path.status, Status::kOk);
        EXPECT_LT(angle_deg(path.direction, -glm::dvec3(camera.world_from_view[2])), 0.01);
        const double cos_inside = std::sqrt(1.0 - std::pow(std::sin(double(angle)) / 1.5, 2.0));
        // The search ends within a 2^-8 of a linear step of each surface.
        EXPECT_NEAR(path.length_inside, count * 0.3 / cos_inside, 1e-3 * count);
    }
}

TEST_F(ManyObjects, SphereBehindSphereIsSeenThroughIt) {
    const Scene scene = scene_of({{"shape:sphere,segments=96", {0.0f, 0.0f, 0.0f}},  //
                                  {"shape:sphere,segments=96", {0.3f, 0.2f, -3.0f}}});
    const Camera camera = front_camera(scene);
    const auto exact = render(scene, camera, "reference").paths;
    const RenderResult result = render(scene, camera);
    // Four interfaces magnify what the search leaves: the depth between two texels at the second sphere.
    EXPECT_GE(within_1deg(result.paths, exact), 0.9);
    EXPECT_LT(within_1deg(render(scene, camera, "one-interface").paths, exact), 0.1);
    const auto through_both =
        std::count_if(result.paths.begin(), result.paths.end(), [](const auto& p) { return p.events >= 4; });
    EXPECT_GT(through_both, 500);
}

TEST_F(ManyObjects, OrderInTheFileDoesNotMatter) {
    std::vector<Placed> solids = {{"shape:cube", {0.0f, 0.0f, 0.0f}, 0.8f},
                                  {"shape:knot", {0.0f, 0.1f, -2.5f}},
                                  {"shape:sphere", {1.4f, 0.3f, -1.2f}, 0.6f},
                                  {"shape:torus", {-1.5f, -0.2f, -1.0f}, 0.7f},
                                  {"shape:gem", {0.2f, -1.0f, 1.1f}, 0.4f}};
    const Scene scene = scene_of(solids);
    const Camera camera = front_camera(scene);
    const auto paths = render(scene, camera).paths;
    const auto exact = render(scene, camera, "reference").paths;
    EXPECT_GT(within_1deg(paths, exact), 0.6);
    std::reverse(solids.begin(), solids.end());
    EXPECT_TRUE(same_paths(paths, render(scene_of(solids), camera).paths));
}

TEST_F(ManyObjects, OverlapAndEqualDepthsBehave) {
    const std::vector<std::vector<Placed>> scenes = {
        // In the same place twice; side by side at equal depth; interlocked; one inside the other; face to face.
        {{"shape:cube", {0, 0, 0}}, {"shape:cube", {0, 0, 0}}},
        {{"shape:sphere", {-1.1f, 0, 0}}, {"shape:sphere", {1.1f, 0, 0}}},
        {{"shape:cube", {0, 0, 0}}, {"shape:sphere", {0.5f, 0.5f, 0}}},
        {{"shape:sphere", {0, 0, 0}}, {"shape:sphere", {0, 0, 0}, 0.5f}},
        {{kSlab, {0, 0, 0}}, {kSlab, {0, 0, -0.3f}}},
    };
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const Scene scene = scene_of(scenes[i]);
        const Camera camera = front_camera(scene);
        const RenderResult result = render(scene, camera);
        EXPECT_TRUE(all_finite(result.radiance)) << i;
        EXPECT_GT(result.covered, 1000u) << i;
        EXPECT_TRUE(same_paths(result.paths, render(scene, camera).paths)) << i;
        for (const LayerBuilder builder : {LayerBuilder::kDepthPeeling, LayerBuilder::kDualDepthPeeling}) {
            EXPECT_TRUE(same_paths(result.paths, render(scene, camera, "wang-2014", builder).paths)) << i;
        }
        for (const RefractedPath& path : result.paths) {
            ASSERT_NEAR(glm::length(path.direction), 1.0f, 1e-4f) << i;
        }
    }
    // Where the eye sees the sphere that looks out of the cube it is the sphere that bends the ray first.
    const Scene scene = scene_of(scenes[2]);
    const Camera camera = front_camera(scene);
    EXPECT_GT(within_1deg(render(scene, camera).paths, render(scene, camera, "reference").paths), 0.5);
}

// A pole before the glass hides surfaces from the eye, not from rays that have come in beside it.
TEST_F(ManyObjects, WhatIsHiddenFromTheEyeIsNotHiddenFromRays) {
    Scene scene = scene_of({{"shape:sphere", {0, 0, 0}}});
    const Camera camera = front_camera(scene);
    const std::vector<RefractedPath> alone = render(scene, camera).paths;
    Scene with_pole =
        scene_of({{"shape:sphere", {0, 0, 0}}, {"shape:slab,width=0.3,height=4,thickness=0.1", {0, 0, 2}}});
    with_pole.materials.emplace_back();  // opaque
    with_pole.objects[1].material = 1;
    const std::vector<RefractedPath> beside = render(with_pole, camera).paths;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < alone.size(); ++i) {
        if (beside[i].events == 0) continue;
        ++seen;
        ASSERT_EQ(beside[i].status, alone[i].status) << i;
        ASSERT_EQ(beside[i].events, alone[i].events) << i;
        ASSERT_LT(angle_deg(beside[i].direction, alone[i].direction), 0.01) << i;
    }
    EXPECT_GT(seen, 1000u);
}

}  // namespace
}  // namespace pellucid::test
