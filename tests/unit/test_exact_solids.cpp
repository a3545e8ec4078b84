// The exact tracer through many solids, opaque surfaces and moving meshes, and what must not matter to it.

#include "test_files.h"
#include "traced_scenes.h"

#include <pellucid/error.h>
#include <pellucid/reference.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

namespace pellucid {
namespace {

using namespace test;

const char* const kClosedShapes[] = {"shape:sphere",        "shape:torus",         "shape:knot",
                                     "shape:goblet",        "shape:gem",           "shape:cube",
                                     "shape:hollow-sphere", "shape:infinity-ring", "shape:bottle"};

/// A box of glass with a cubic cavity of 1 m, and a cube of water of the given size in it.
Scene water_in_glass(float water_size, bool water_first, const glm::mat4& placed) {
    const Mesh box = with_flat_normals(joined(cube(2.0f), inside_out(cube(1.0f))));
    const Mesh water = with_flat_normals(cube(0.25f * water_size));
    Scene scene;
    if (!water_first) add(scene, box, glass(1.5f), placed);
    add(scene, water, glass(1.33f), placed * glm::scale(glm::mat4(1), glm::vec3(4.0f)));
    if (water_first) add(scene, box, glass(1.5f), placed);
    return scene;
}

/// Off all axes, so that equal places are rounded differently in different objects.
glm::mat4 askew() {
    return glm::rotate(glm::translate(glm::mat4(1), {3.1f, -0.7f, 0.3f}), 0.4f,
                       glm::normalize(glm::vec3(0.3f, 0.8f, 0.5f)));
}

TEST(ExactSolids, WaterThatTouchesTheGlassIsWaterInGlass) {
    for (const glm::mat4& placed : {glm::mat4(1), askew()}) {
        const Scene overlapping = water_in_glass(1.001f, false, placed);
        const Camera camera = view_of(overlapping, 20.0f);
        const std::uint32_t size = 128;
        const std::vector<RefractedPath> expected = trace(overlapping, camera, size);
        std::size_t through_both = 0;
        for (const RefractedPath& path : expected) through_both += path.events == 4 && path.reflections == 0;
        EXPECT_GT(through_both, 500u);
        for (const bool water_first : {false, true}) {
            const std::vector<RefractedPath> touching = trace(water_in_glass(1.0f, water_first, placed), camera, size);
            double same = 0, covered = 0;
            for (std::size_t i = 0; i < touching.size(); ++i) {
                EXPECT_NE(touching[i].status, Status::kMissingLayer) << i;
                if (expected[i].events == 0) continue;
                ++covered;
                same += touching[i].events == expected[i].events &&
                        angle_deg(touching[i].direction, expected[i].direction) < 0.01;
            }
            EXPECT_GT(same / covered, 0.99);  // the overlap moves edges by 0.5 mm
        }
        // A gap is air: two interfaces more on the way.
        const std::vector<RefractedPath> apart = trace(water_in_glass(0.999f, false, placed), camera, size);
        std::size_t through_gaps = 0;
        for (const RefractedPath& path : apart) through_gaps += path.events >= 6;
        EXPECT_GT(through_gaps, 500u);
    }
}

TEST(ExactSolids, SmallerSolidDisplacesTheLarger) {
    Scene scene;
    Material larger = glass(1.5f), smaller = glass(1.7f);
    larger.attenuation_color = {0.5f, 1.0f, 1.0f};
    larger.attenuation_distance = 1.0f;
    smaller.attenuation_color = {1.0f, 0.5f, 1.0f};
    smaller.attenuation_distance = 1.0f;
    add(scene, with_flat_normals(cube(1.0f)), smaller);
    add(scene, with_flat_normals(cube(3.0f)), larger);
    const RefractedPath path = trace_ray(scene, {0.1f, 0.2f, 0.0f}, {0, 0, -1});
    EXPECT_EQ(path.events, 4);
    EXPECT_FLOAT_EQ(path.length_inside, 3.0f);
    // 2 m in the larger, 1 m in the smaller.
    EXPECT_NEAR(path.transmittance.r / path.transmittance.b, 0.25f, 1e-5f);
    EXPECT_NEAR(path.transmittance.g / path.transmittance.b, 0.5f, 1e-5f);
}

TEST(ExactSolids, ShellsOfOneMeshMerge) {
    const Scene scene = scene_of(with_flat_normals(joined(cube(1.0f), cube(1.0f, {0.0f, 0.0f, 0.5f}))));
    const RefractedPath path = trace_ray(scene, {0.1f, 0.2f, 0.0f}, {0, 0, -1});
    EXPECT_EQ(path.events, 2);
    EXPECT_FLOAT_EQ(path.length_inside, 1.5f);
}

TEST(ExactSolids, OpenSurfaceGoesByItsNormal) {
    const Scene scene = scene_of(square());
    const glm::vec3 target(0.2f, 0.1f, 0.0f);
    const glm::vec3 slanted = glm::normalize(glm::vec3(0.3f, 0.0f, 1.0f));
    const RefractedPath in = trace_ray(scene, target, -slanted);
    EXPECT_EQ(in.events, 1);
    EXPECT_EQ(in.status, Status::kOk);
    EXPECT_NEAR(in.direction.x, -slanted.x / 1.5f, 1e-6f);
    const RefractedPath out = trace_ray(scene, target, slanted);  // as if it came from inside
    EXPECT_EQ(out.events, 1);
    EXPECT_NEAR(out.direction.x, slanted.x * 1.5f, 1e-6f);
}

TEST(ExactSolids, PathEndsOnTheOpaqueSurfaceBehindGlass) {
    Scene scene = load_scene("shape:slab,width=20,height=20,thickness=0.5");
    add(scene, square(), Material{}, glm::translate(glm::mat4(1), {0.0f, 0.0f, -2.25f}));
    const glm::vec3 d = glm::normalize(glm::vec3(0.3f, 0.0f, -1.0f));
    const RefractedPath path = trace_ray(scene, {0.0f, 0.1f, 0.25f}, d);
    const float sin_t = d.x / 1.5f;
    const float x = 0.5f * sin_t / std::sqrt(1.0f - sin_t * sin_t) + 2.0f * 0.3f;
    EXPECT_EQ(path.object, 1);
    EXPECT_EQ(path.events, 2);
    EXPECT_LT(glm::distance(path.position, glm::vec3(x, 0.1f, -2.25f)), 1e-5f);
    const RefractedPath beside = trace_ray(scene, {5.0f, 0.1f, 0.25f}, d);
    EXPECT_EQ(beside.object, -1);
}

TEST(ExactSolids, GlassOnATableIsLeftBeforeTheTableIsMet) {
    // The bottom of the cube and the table lie in one plane, on axis and, but for rounding, askew.
    for (const glm::mat4& placed : {glm::mat4(1), askew()}) {
        for (const bool table_first : {false, true}) {
            Scene scene;
            const glm::mat4 below =
                glm::translate(placed, {0.0f, 0.0f, -0.5f}) * glm::scale(glm::mat4(1), glm::vec3(3.0f, 3.0f, 1.0f));
            if (table_first) add(scene, square(), Material{}, below);
            add(scene, with_flat_normals(cube(1.0f)), glass(), placed);
            if (!table_first) add(scene, square(), Material{}, below);
            const auto from = [&](const glm::vec3& target, const glm::vec3& direction) {
                return trace_ray(scene, placed * glm::vec4(target, 1.0f), glm::mat3(placed) * direction);
            };
            const RefractedPath through = from({0.1f, 0.2f, 0.0f}, {0, 0, -1});
            EXPECT_EQ(through.events, 2);
            EXPECT_EQ(through.object, table_first ? 0 : 1);
            // In by the side, the bottom reflects totally, out by the other side and away.
            const RefractedPath reflected = from({-0.5f, 0.1f, -0.4f}, glm::normalize(glm::vec3(1.0f, 0.0f, -0.4f)));
            EXPECT_EQ(reflected.events, 3);
            EXPECT_EQ(reflected.reflections, 1);
            EXPECT_EQ(reflected.object, -1);
            EXPECT_EQ(reflected.status, Status::kOk);
        }
    }
}

TEST(ExactSolids, ThinWallsAndHolesLetPathsThrough) {
    Material pane = glass();
    pane.thickness = 0.0f;
    const glm::vec3 slanted = glm::normalize(glm::vec3(0.3f, 0.1f, -1.0f));
    const RefractedPath through = trace_ray(scene_of(square(), pane), glm::vec3(0.0f), slanted);
    EXPECT_EQ(through.events, 0);
    EXPECT_EQ(through.object, -1);

    Material cut_out;
    cut_out.alpha_cutoff = 0.5f;
    Mesh half = square();
    half.colors = {{1, 1, 1, 0}, {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 0}};  // alpha grows with x
    const Scene scene = scene_of(half, cut_out);
    EXPECT_EQ(trace_ray(scene, {-0.5f, 0.1f, 0.0f}, {0, 0, -1}).object, -1);
    EXPECT_EQ(trace_ray(scene, {0.5f, 0.1f, 0.0f}, {0, 0, -1}).object, 0);
}

TEST(ExactSolids, CameraPlanesCutOffWhatItSees) {
    Scene scene;
    for (const float z : {0.0f, -1.0f, -2.0f}) {
        add(scene, square(), Material{}, glm::translate(glm::mat4(1), {0.0f, 0.0f, z}));
    }
    for (const bool orthographic : {false, true}) {
        Camera camera = parallel_camera({0.1f, 0.2f, 0.0f}, {0, 0, -1}, 0.01f, 10.0f);
        camera.orthographic = orthographic;
        camera.near_plane = 10.5f;
        EXPECT_EQ(trace(scene, camera, 1).front().object, 1);
        EXPECT_NEAR(trace(scene, camera, 1).front().length, 11.0f, 1e-5f);
        camera.far_plane = 10.75f;
        EXPECT_EQ(trace(scene, camera, 1).front().object, -1);
        // To less than what the search in single precision is let run on.
        camera.near_plane = 0.0f;
        camera.far_plane = 10.00001f;
        EXPECT_EQ(trace(scene, camera, 1).front().object, 0);
        camera.far_plane = 9.99999f;
        EXPECT_EQ(trace(scene, camera, 1).front().object, -1);
    }
    Scene sphere = load_scene("shape:sphere");
    Camera inside = parallel_camera(glm::vec3(0.0f), {0, 0, -1}, 0.01f, 10.0f);
    inside.near_plane = 10.0f;
    EXPECT_EQ(trace(sphere, inside, 1).front().events, 1);
}

TEST(ExactSolids, MirroredObjectGivesTheMirroredPicture) {
    const Scene scene = load_scene("shape:knot");
    Scene mirrored = scene;
    mirrored.objects[0].world_from_object[0][0] = -1.0f;
    const std::uint32_t size = 128;
    const std::vector<RefractedPath> paths = trace(scene, view_of(scene, 40.0f), size);
    std::vector<RefractedPath> turned = trace(mirrored, view_of(mirrored, -40.0f), size);
    for (std::size_t y = 0; y < size; ++y) {
        std::reverse(turned.begin() + long(y * size), turned.begin() + long((y + 1) * size));
    }
    for (RefractedPath& path : turned) path.direction.x = -path.direction.x;
    EXPECT_GT(agreement(paths, turned, 0.01), 0.98);
}

TEST(ExactSolids, PacketsAndThreadsDoNotMatter) {
    const Scene scene = load_scene("shape:goblet");
    const Camera camera = view_of(scene, 10.0f);
    ExactSettings settings;
    settings.width = 101;  // no multiple of any packet's block
    settings.height = 67;
    const std::vector<RefractedPath> expected = Tracer(scene, {.threads = 1}).exact(camera, settings);
    for (const std::uint32_t packet : {1u, 4u, 8u, 16u}) {
        settings.packet = packet;
        for (const std::uint32_t threads : {0u, 1u, 2u}) {
            const Tracer tracer(scene, {.threads = threads});
            EXPECT_EQ(count_different(expected, tracer.exact(camera, settings)), 0u) << packet << " " << threads;
        }
    }
}

TEST(ExactSolids, OrderOfVerticesAndWeldingDoNotMatter) {
    const Scene scene = load_scene("shape:torus");
    const Camera camera = view_of(scene, 0.0f);
    const std::vector<RefractedPath> expected = trace(scene, camera, 128);
    Scene turned = scene;
    for (glm::uvec3& t : turned.meshes[0].triangles) t = {t.y, t.z, t.x};
    EXPECT_GT(agreement(expected, trace(turned, camera, 128), 0.01), 0.995);
    Scene split = scene;
    split.meshes[0] = unwelded(scene.meshes[0]);
    EXPECT_GT(agreement(expected, trace(split, camera, 128), 0.01), 0.995);
}

TEST(ExactSolids, FinerFlatTrianglesDoNotMatter) {
    const Scene scene = load_scene("shape:cube");
    const Camera camera = view_of(scene, 30.0f);
    EXPECT_GT(agreement(trace(scene, camera, 128), trace(load_scene("shape:cube,segments=20"), camera, 128), 0.001),
              0.999);
}

std::size_t lost_paths(const Scene& scene, std::uint32_t size) {
    const Tracer tracer(scene);
    ExactSettings settings;
    settings.width = settings.height = size;
    std::size_t lost = 0;
    for (int view = 0; view < 8; ++view) {
        for (const RefractedPath& path : tracer.exact(view_of(scene, 45.0f * float(view)), settings)) {
            lost += path.status == Status::kMissingLayer;
        }
    }
    return lost;
}

TEST(ExactSolids, NoPathIsLostInAClosedShape) {
    for (const char* shape : kClosedShapes) EXPECT_EQ(lost_paths(load_scene(shape), 192), 0u) << shape;
}

TEST(ExactSolids, NoPathIsLostInAClosedModel) {
    if (data_folder().empty()) GTEST_SKIP() << "PELLUCID_TEST_DATA names no folder with models";
    for (const char* model : {"bunny_closed_69664.obj", "cow.obj", "spot.obj", "gen_torus_576.obj", "horse.ply"}) {
        const std::filesystem::path file = data_folder() / "models" / model;
        EXPECT_EQ(lost_paths(load_scene(file.string()), 192), 0u) << model;
    }
}

TEST(ExactSolids, MovedMeshTracesLikeANewOne) {
    const Scene scene = load_scene("shape:torus");
    Scene moved = scene;
    for (std::size_t i = 0; i < scene.meshes[0].positions.size(); ++i) {
        glm::vec3& p = moved.meshes[0].positions[i];
        p.y += 0.3f * std::sin(3.0f * p.x);
    }
    const Camera camera = view_of(moved, 0.0f);
    ExactSettings settings;
    settings.width = settings.height = 96;
    const std::vector<RefractedPath> expected = Tracer(moved).exact(camera, settings);
    Tracer tracer(scene, {.deforming = true});
    EXPECT_GT(count_different(expected, tracer.exact(camera, settings)), 0u);
    const Mesh& mesh = moved.meshes[0];
    for (const auto update : {Tracer::Update::kRefit, Tracer::Update::kRebuild, Tracer::Update::kRefit}) {
        tracer.set_positions({{0, scene.meshes[0].positions, scene.meshes[0].normals}}, update);
        tracer.set_positions({{0, mesh.positions, mesh.normals}}, update);
        EXPECT_EQ(count_different(expected, tracer.exact(camera, settings)), 0u);
        EXPECT_GT(tracer.build_ms(), 0.0);
    }
}

TEST(ExactSolids, MeshesMoveTogetherOrNotAtAll) {
    Scene scene = load_scene("shape:sphere,segments=16");
    add(scene, load_scene("shape:torus,segments=24,sides=12").meshes[0], glass());
    Scene moved = scene;
    for (Mesh& mesh : moved.meshes)
        for (glm::vec3& p : mesh.positions) p.y *= 1.2f;
    const Camera camera = view_of(moved, 0.0f);
    const ExactSettings settings{.width = 64, .height = 64};
    const std::vector<MovedMesh> update{{0, moved.meshes[0].positions, scene.meshes[0].normals},
                                        {1, moved.meshes[1].positions, scene.meshes[1].normals}};
    const std::vector<RefractedPath> before = Tracer(scene).exact(camera, settings);
    for (const auto how : {Tracer::Update::kRefit, Tracer::Update::kRebuild}) {
        Tracer tracer(scene, {.deforming = true});
        EXPECT_THROW(tracer.set_positions({update[0], {7, update[1].positions, update[1].normals}}, how), Error);
        EXPECT_EQ(count_different(before, tracer.exact(camera, settings)), 0u);
        tracer.set_positions(update, how);
        EXPECT_EQ(count_different(Tracer(moved).exact(camera, settings), tracer.exact(camera, settings)), 0u);
    }
}

TEST(ExactSolids, ProgressIsToldOneAtATime) {
    const Scene scene = load_scene("shape:sphere");
    std::atomic<int> within = 0;
    double last = 0.0;
    bool overlapped = false, grew = true;
    Tracer(scene).exact(view_of(scene, 0.0f), {.width = 200, .height = 100}, [&](double share) {
        overlapped = overlapped || within.fetch_add(1) != 0;
        grew = grew && share > last;
        last = share;
        --within;
    });
    EXPECT_FALSE(overlapped);
    EXPECT_TRUE(grew);
    EXPECT_EQ(last, 1.0);
}

}  // namespace
}  // namespace pellucid
