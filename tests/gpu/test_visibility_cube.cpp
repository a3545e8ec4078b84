// Techniques that find surfaces beyond the view, against the exact tracer; and what visibility-cube keeps from frame to
// frame.
#include "gpu/device_test.h"
#include "layers/mesh_maps.h"

#include <gmock/gmock.h>

#include <fmt/format.h>

namespace pellucid::test {
namespace {

constexpr std::uint32_t kSize = 128;

/// Share of the pixels whose exact path ends within the limit of events on which `found` agrees to a degree.
double agreement(const std::vector<RefractedPath>& found, std::vector<RefractedPath> exact) {
    for (RefractedPath& path : exact) {
        if (path.status != Status::kOk) path.events = 0;
    }
    return within_1deg(found, exact);
}

template <class Base>
class FinderTests : public Base {
protected:
    using Base::renderer;
    RenderSettings settings(const char* technique, ParameterMap parameters = {}) {
        RenderSettings settings;
        settings.width = settings.height = kSize;
        settings.technique = technique;
        settings.parameters = std::move(parameters);
        settings.paths = true;
        return settings;
    }
    std::vector<RefractedPath> paths(const char* technique, ParameterMap parameters = {}) {
        return renderer().render(settings(technique, std::move(parameters))).paths;
    }
    void set_up(const Scene& scene, const Camera& camera) {
        renderer().set_scene(scene);
        renderer().set_environment(uniform_environment());
        renderer().set_camera(camera);
    }
    double right(const char* technique, ParameterMap parameters = {}) {
        return agreement(paths(technique, std::move(parameters)), paths("reference"));
    }
};
class VisibilityCube : public FinderTests<RendererTest> {};

/// What holds of all that look beyond the view.
class Finders : public FinderTests<TechniqueTest> {};
INSTANTIATE_TEST_SUITE_P(All, Finders, testing::Values("visibility-cube", "ray-tracing", "ray-tracing-cpu"),
                         technique_test_name);

Camera view_of(const Scene& scene, float azimuth_deg = 20.0f, float share_of_height = 0.8f) {
    return orbit_camera(scene_bounds(scene), azimuth_deg, 15.0f, framing_distance(0.5236f, share_of_height), 0.5236f);
}

Camera camera_at(glm::vec3 position, glm::vec3 target, float vertical_fov) {
    Camera camera;
    camera.vertical_fov = vertical_fov;
    camera.world_from_view = glm::inverse(glm::lookAt(position, target, glm::vec3(0, 1, 0)));
    return camera;
}

/// Objects of one glass, each `shape` with a transform; shapes of one name are one mesh.
Scene scene_of(const std::vector<std::pair<const char*, glm::mat4>>& placed) {
    Scene scene;
    std::map<std::string, int> meshes;
    for (const auto& [shape, world_from_object] : placed) {
        const auto [known, is_new] = meshes.try_emplace(shape, int(scene.meshes.size()));
        Object object;
        if (is_new) {
            Scene loaded = load_scene(shape);
            scene.meshes.push_back(std::move(loaded.meshes.front()));
            if (scene.materials.empty()) scene.materials.push_back(loaded.materials.front());
        }
        object.mesh = known->second;
        object.world_from_object = world_from_object;
        scene.objects.push_back(object);
    }
    return scene;
}

glm::mat4 at(float x, float y, float z) { return glm::translate(glm::mat4(1.0f), glm::vec3(x, y, z)); }
glm::mat4 scaled(float x, float y, float z) { return glm::scale(glm::mat4(1.0f), glm::vec3(x, y, z)); }
glm::mat4 turned(float angle, glm::vec3 axis) { return glm::rotate(glm::mat4(1.0f), angle, glm::normalize(axis)); }

/// Two meshes shown turned, mirrored, larger, and, that of flat faces, stretched and stretched askew.
Scene instances() {
    const char* const knot = "shape:knot";
    const char* const gem = "shape:gem";
    return scene_of(
        {{knot, turned(0.7f, {1, 2, 3})},
         {knot, at(0.4f, 0.3f, -3) * scaled(-1.3f, 1.3f, 1.3f)},
         {gem, at(-2.0f, 0.2f, -1) * scaled(0.5f, 1.5f, 1.0f)},
         {gem, at(2.0f, -0.3f, -1) * turned(0.5f, {0, 1, 1}) * scaled(1.2f, -0.6f, 0.9f) * turned(0.8f, {1, 0, 1})}});
}

TEST_P(Finders, FollowsExactPathsThroughShapes) {
    for (const char* shape : {"sphere", "cube", "torus", "knot", "goblet", "hollow-sphere"}) {
        const Scene scene = load_scene(std::string("shape:") + shape);
        set_up(scene, view_of(scene));
        EXPECT_GE(right(GetParam()), 0.99) << shape;
    }
}

TEST_F(VisibilityCube, ResolutionIsOfSpeedNotOfAccuracy) {
    const Scene scene = load_scene("shape:knot");
    set_up(scene, view_of(scene));
    for (const double resolution : {17.0, 100.0, 1500.0})
        EXPECT_GE(right("visibility-cube", {{"resolution", resolution}}), 0.99) << resolution;
}

TEST_P(Finders, ParallelViewRaysAreFollowedToo) {
    const Scene scene = load_scene("shape:torus");
    Camera camera = view_of(scene);
    camera.orthographic = true;
    camera.vertical_extent = 2.6f;
    set_up(scene, camera);
    EXPECT_GE(right(GetParam()), 0.99);
}

TEST_P(Finders, InstancesAreFoundWhereverTheyAre) {
    const Scene scene = instances();
    set_up(scene, view_of(scene, 0.0f));
    const auto exact = paths("reference"), found = paths(GetParam());
    EXPECT_GE(agreement(found, exact), 0.99);
    const auto through_two = std::count_if(exact.begin(), exact.end(), [](const auto& p) { return p.events > 4; });
    EXPECT_GT(through_two, 100);
}

TEST_F(VisibilityCube, SharedMapsAreAsGoodAsOwnOnes) {
    const Scene scene = instances();
    set_up(scene, view_of(scene, 0.0f));
    const auto shared = paths("visibility-cube");
    Scene apart = scene;
    for (std::size_t i = 1; i < apart.objects.size(); ++i) {
        apart.objects[i].mesh = int(apart.meshes.size());
        apart.meshes.push_back(scene.meshes[std::size_t(scene.objects[i].mesh)]);
    }
    renderer().set_scene(apart);
    // A ray through an edge meets one of its two triangles, whichever lies first in its texel.
    EXPECT_GE(agreement(shared, paths("visibility-cube")), 0.995);
}

// A solid within another displaces it; where faces coincide, only what is entered and left counts.
TEST_P(Finders, OverlappingSolidsDisplaceEachOther) {
    const char* const slab = "shape:slab,width=2,height=2,thickness=0.3";
    for (const Scene& scene :
         {scene_of({{"shape:cube", at(0, 0, 0)}, {"shape:sphere", at(0.5f, 0.5f, 0) * scaled(0.6f, 0.6f, 0.6f)}}),
          scene_of({{"shape:sphere", at(0, 0, 0)}, {"shape:sphere", scaled(0.5f, 0.5f, 0.5f)}}),
          scene_of({{slab, at(0, 0, 0)}, {slab, at(0, 0, -0.3f)}})}) {
        Scene of_two = scene;
        of_two.materials.push_back(of_two.materials[0]);
        of_two.materials[1].ior = 1.2f;
        of_two.objects[1].material = 1;
        set_up(of_two, view_of(of_two));
        EXPECT_GE(right(GetParam()), 0.99) << scene.meshes[0].name;
    }
}

// The plate that the glass stands on, in a room.
TEST_P(Finders, PathsEndOnOpaqueObjectsAnywhere) {
    const char* const plate = "shape:slab,width=6,height=6,thickness=0.2";
    Scene scene = scene_of({{"shape:cube", turned(0.4f, {0, 1, 0})},
                            {plate, at(0, -0.7f, 0) * turned(1.5707964f, {1, 0, 0})},
                            {"shape:cube", scaled(9, 8, 10)}});
    scene.materials.emplace_back();
    scene.objects[1].material = scene.objects[2].material = 1;
    set_up(scene, camera_at({0.8f, 1.2f, 3.5f}, {0, 0, 0}, 0.5f));
    const auto exact = paths("reference"), found = paths(GetParam());
    EXPECT_GE(agreement(found, exact), 0.99);
    std::array<int, 3> met{};
    int same = 0, all = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        if (exact[i].events == 0 || exact[i].status != Status::kOk) continue;
        ++all;
        same += found[i].object == exact[i].object ? 1 : 0;
        ++met[std::size_t(std::max(exact[i].object, 0))];
    }
    EXPECT_GE(same, 0.99 * all);
    EXPECT_GT(met[1], 500);
    EXPECT_GT(met[2], 50);
}

// Rays that leave the picture, or come back past the eye, meet what a map of the view would not hold. Where glass lies
// beside the view, visibility-layers takes maps of the meshes, too.
TEST_P(Finders, SeesWhatTheViewDoesNot) {
    const Scene scene = load_scene("shape:knot");
    const Bounds bounds = scene_bounds(scene);
    const glm::vec3 eye = bounds.center + glm::vec3(0.3f, 0.2f, 1.0f) * 1.6f * bounds.radius;
    set_up(scene, camera_at(eye, bounds.center + glm::vec3(0.5f, 0.2f, 0.0f) * bounds.radius, 0.2f));
    const auto exact = paths("reference");
    EXPECT_GE(agreement(paths(GetParam()), exact), 0.99);
    EXPECT_GE(agreement(paths("visibility-layers"), exact), 0.99);
}

TEST_P(Finders, SeesFromInsideTheGlass) {
    const Scene scene = load_scene("shape:cube");
    set_up(scene, camera_at({0.1f, 0.05f, 0.2f}, {0.2f, 0.1f, -1.0f}, 0.9f));
    EXPECT_GE(right(GetParam()), 0.99);
    const Scene ring = load_scene("shape:torus");
    set_up(ring, camera_at({0.7f, 0.0f, 0.05f}, {0.7f, 0.02f, 1.0f}, 0.6f));
    EXPECT_GE(right(GetParam()), 0.99);
}

/// So many surfaces behind each other that the room chosen at first is too small, and for tiles of triangles, too.
TEST_P(Finders, RoomIsMadeForAllSurfaces) {
    constexpr int kPlates = 24;
    const Mesh plate = load_scene("shape:slab,width=2,height=2,thickness=0.02").meshes.front();
    Scene scene = load_scene("shape:slab");
    Mesh& all = scene.meshes[0];
    all = Mesh{};
    for (int i = 0; i < kPlates; ++i) {
        const auto first = std::uint32_t(all.positions.size());
        for (const glm::vec3& p : plate.positions) all.positions.push_back(p - glm::vec3(0, 0, 0.05f * float(i)));
        all.normals.insert(all.normals.end(), plate.normals.begin(), plate.normals.end());
        for (const glm::uvec3& t : plate.triangles) all.triangles.push_back(t + first);
    }
    Camera camera;
    camera.orthographic = true;
    camera.vertical_extent = 0.4f;
    camera.world_from_view = turned(0.3f, {0, 1, 0}) * at(0, 0, 10);
    set_up(scene, camera);
    const auto found = paths(GetParam(), {{"events", 100}});
    for (const RefractedPath& path : found) {
        ASSERT_EQ(path.events, 2 * kPlates);
        ASSERT_EQ(path.status, Status::kOk);
        ASSERT_LT(angle_deg(path.direction, -glm::dvec3(camera.world_from_view[2])), 0.01);
    }
}

TEST_P(Finders, DeformedMeshesAreFoundAnew) {
    Scene scene = scene_of(
        {{"shape:torus", at(0, 0, 0)}, {"shape:sphere", at(1.5f, 0.8f, 0.3f)}, {"shape:torus", at(-1, -1, 0.5f)}});
    set_up(scene, view_of(scene));
    EXPECT_GE(right(GetParam()), 0.98);
    for (int frame = 1; frame <= 3; ++frame) {
        Mesh& mesh = scene.meshes[0];
        for (glm::vec3& p : mesh.positions) p *= glm::vec3(1.2f, frame == 2 ? 1.8f : 0.7f, 1.0f);
        for (glm::vec3& n : mesh.normals) n = glm::normalize(n / glm::vec3(1.2f, frame == 2 ? 1.8f : 0.7f, 1.0f));
        renderer().set_positions({{0, mesh.positions, mesh.normals}});
        EXPECT_GE(right(GetParam()), 0.98) << frame;
    }
}

// Whoever finds a surface, a path intersects it by the same formulas: pictures of visibility-layers, of Embree and of the device's ray tracing part only
// by rounding, which compilers place differently in different programs and long paths amplify (to 1e-3 of the light here),
// and where a ray passes within rounding of an edge.
TEST_P(Finders, PicturesAreTheSameToRounding) {
    if (GetParam() == std::string("visibility-cube")) GTEST_SKIP() << "its triangles are in the frames of meshes";
    for (const Scene& scene : {load_scene("shape:knot"), load_scene("shape:goblet"), instances()}) {
        set_up(scene, view_of(scene, 20.0f, 0.5f));  // all boxes in the view, so that it has a map
        renderer().set_environment(Environment{});
        const Image expected = renderer().render(settings("visibility-layers", {{"branches", 4}})).radiance;
        const Image found = renderer().render(settings(GetParam(), {{"branches", 4}})).radiance;
        std::size_t differing = 0;
        for (std::size_t i = 0; i < expected.pixels.size(); ++i)
            differing += std::abs(expected.pixels[i] - found.pixels[i]) > 1e-3f * (expected.pixels[i] + 0.01f) ? 1 : 0;
        EXPECT_LE(differing, expected.pixels.size() / 500) << scene.meshes[0].name;
        RecordProperty(scene.meshes[0].name, std::to_string(differing));
    }
}

// Parallel rays that begin within the glass and beside it: each finds by itself what it is in.
TEST_P(Finders, EveryRayFindsWhatItBeginsIn) {
    const Scene scene =
        scene_of({{"shape:torus", turned(1.2f, {1, 0, 0})}, {"shape:sphere", scaled(0.3f, 0.3f, 0.3f)}});
    Camera camera = view_of(scene);
    camera.orthographic = true;
    camera.vertical_extent = 2.6f;
    const glm::vec3 forward(-camera.world_from_view[2]);
    camera.world_from_view[3] = glm::vec4(scene_bounds(scene).center - 0.05f * forward, 1.0f);
    set_up(scene, camera);
    EXPECT_GE(right(GetParam()), 0.99);
}

bool times_maps(const RenderResult& result) {
    return std::any_of(result.frames.at(0).begin(), result.frames.at(0).end(),
                       [](const PassTime& pass) { return pass.name == "mesh maps"; });
}

TEST_F(VisibilityCube, MapsAreKeptUntilTheMeshMoves) {
    const Scene scene = scene_of({{"shape:torus", at(0, 0, 0)}, {"shape:sphere", at(1.5f, 0.8f, 0.3f)}});
    set_up(scene, view_of(scene));
    const RenderResult first = renderer().render(settings("visibility-cube"));
    if (first.frames.at(0).empty()) GTEST_SKIP() << "no timestamps";
    EXPECT_TRUE(times_maps(first));
    EXPECT_FALSE(times_maps(renderer().render(settings("visibility-cube"))));
    renderer().set_camera(view_of(scene, 80.0f));
    EXPECT_FALSE(times_maps(renderer().render(settings("visibility-cube"))));
    RenderSettings smaller = settings("visibility-cube");
    smaller.width = 50;
    renderer().render(settings("wang-2014"));
    EXPECT_FALSE(times_maps(renderer().render(smaller)));
    EXPECT_TRUE(times_maps(renderer().render(settings("visibility-cube", {{"resolution", 100}}))));
    renderer().set_positions({{1, scene.meshes[1].positions, scene.meshes[1].normals}});
    EXPECT_TRUE(times_maps(renderer().render(settings("visibility-cube", {{"resolution", 100}}))));
    renderer().set_scene(scene);
    EXPECT_TRUE(times_maps(renderer().render(settings("visibility-cube", {{"resolution", 100}}))));
}

class MeshMapsTest : public DeviceTest {};

TEST_F(MeshMapsTest, OnlyWhatMovesIsBuiltAnew) {
    Scene scene = scene_of(
        {{"shape:torus", at(0, 0, 0)}, {"shape:sphere", at(1.5f, 0.8f, 0.3f)}, {"shape:torus", at(-1, -1, 0.5f)}});
    scene.meshes.push_back(load_scene("shape:cube").meshes.front());  // which no object shows
    GpuScene on_device(device(), scene);
    const Buffer constants(device(), "constants", sizeof(gpu::FrameConstants), vk::BufferUsageFlagBits::eStorageBuffer,
                           true);
    const GpuImage& none = workspace().image("environment", vk::Format::eR32G32B32A32Sfloat, {1, 1});
    const Frame frame{workspace(), on_device, constants, {}, none, none, 0, {8, 8}};
    MeshMaps maps;
    const auto built = [&] {
        on_device.prepare_topology(device(), scene);
        recorder().upload_pending();
        maps.bring_up_to_date(recorder(), frame, 64);
        const std::vector<std::uint32_t> meshes = maps.building();
        recorder().submit_and_wait();
        while (maps.must_repeat()) {
            maps.bring_up_to_date(recorder(), frame, 64);
            recorder().submit_and_wait();
        }
        return meshes;
    };
    using testing::ElementsAre;
    EXPECT_THAT(built(), ElementsAre(0, 1));
    EXPECT_THAT(built(), ElementsAre());
    for (glm::vec3& p : scene.meshes[1].positions) p.y *= 0.9f;
    on_device.move_vertices(device(), scene, std::array{1});
    EXPECT_THAT(built(), ElementsAre(1));
    on_device.move_vertices(device(), scene, std::array{2});
    EXPECT_THAT(built(), ElementsAre());
    // A box of other proportions does not fit where the old one was.
    for (glm::vec3& p : scene.meshes[0].positions) p.z *= 3.0f;
    on_device.move_vertices(device(), scene, std::array{0});
    EXPECT_THAT(built(), ElementsAre(0, 1));
    EXPECT_THAT(built(), ElementsAre());
}

}  // namespace
}  // namespace pellucid::test
