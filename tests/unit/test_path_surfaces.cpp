// Surfaces of exact paths and refractive flow against what is known without the tracer.

#include "lab/dataset_scene.h"
#include "traced_scenes.h"

#include <pellucid/combine.h>
#include <pellucid/error.h>
#include <pellucid/path_surfaces.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pellucid {
namespace {

using glm::dvec3;
using namespace test;

constexpr std::uint32_t kSize = 96;

std::vector<RefractedPath> paths_of(const std::vector<SurfacePath>& traced) {
    std::vector<RefractedPath> paths;
    for (const SurfacePath& each : traced) paths.push_back(each.path);
    return paths;
}

TEST(PathSurfaces, SphereIsMetWhereASphereLies) {
    Scene scene = load_scene("shape:sphere,segments=256");
    scene.materials[0].attenuation_color = glm::vec3(0.5f, 0.8f, 1.0f);
    scene.materials[0].attenuation_distance = 0.7f;
    const Camera camera = view_of(scene, 0.0f);
    const dvec3 eye(camera.world_from_view[3]);
    std::size_t covered = 0;
    for (const SurfacePath& each : SurfaceTracer(scene).trace(camera, {.width = kSize, .height = kSize})) {
        if (each.path.events == 0) {
            EXPECT_EQ(each.first.object, -1);
            EXPECT_EQ(each.fresnel, 1.0f);
            continue;
        }
        ++covered;
        ASSERT_EQ(each.path.events, 2);
        EXPECT_NEAR(glm::length(each.first.position), 1.0f, 1e-3f);
        EXPECT_NEAR(glm::distance(each.first.position, each.first.normal), 0.0f, 1e-3f);  // a unit sphere
        EXPECT_EQ(each.second.position, each.last.position);
        EXPECT_NEAR(glm::distance(each.last.position, each.last.normal), 0.0f, 1e-3f);
        const double chord = glm::distance(dvec3(each.first.position), dvec3(each.last.position));
        EXPECT_NEAR(each.attenuation.r, std::pow(0.5, chord / 0.7), 1e-4);
        EXPECT_EQ(each.attenuation.b, 1.0f);
        // Both interfaces have the reflectance of the angle of incidence, for unpolarised light.
        const double cos_i = -glm::dot(glm::normalize(dvec3(each.first.position) - eye), dvec3(each.first.normal));
        const double cos_t = std::sqrt(1.0 - (1.0 - cos_i * cos_i) / 2.25);
        const double s = (cos_i - 1.5 * cos_t) / (cos_i + 1.5 * cos_t),
                     p = (1.5 * cos_i - cos_t) / (1.5 * cos_i + cos_t);
        EXPECT_NEAR(each.fresnel, std::pow(1.0 - 0.5 * (s * s + p * p), 2.0), 0.02);
        EXPECT_NEAR(each.path.transmittance.r, each.fresnel * each.attenuation.r, 1e-5);
    }
    EXPECT_GT(covered, 1000u);
}

TEST(PathSurfaces, PathsAreThoseOfTheTracer) {
    const Scene scene = load_scene("shape:knot");
    const Camera camera = view_of(scene, 0.3f);
    const ExactSettings settings{.width = kSize, .height = kSize};
    const std::vector<RefractedPath> exact = Tracer(scene).exact(camera, settings);
    const std::vector<SurfacePath> traced = SurfaceTracer(scene).trace(camera, settings);
    ASSERT_EQ(exact.size(), traced.size());
    for (std::size_t i = 0; i < exact.size(); ++i) {
        EXPECT_EQ(exact[i].direction, traced[i].path.direction);
        EXPECT_EQ(exact[i].position, traced[i].path.position);
        EXPECT_EQ(exact[i].events, traced[i].path.events);
        if (exact[i].events > 1) {
            EXPECT_EQ(exact[i].position, traced[i].last.position);
        }
    }
}

/// A slab of thickness d moves the image of a background sideways by d (tan a - tan b) before it is projected.
TEST(RefractiveFlow, SlabShiftsThePlaneBehindIt) {
    constexpr double kDepth = 6.0, kThick = 0.5;
    Scene scene = load_scene("shape:slab,width=20,height=20,thickness=0.5");
    Camera camera;
    camera.world_from_view[3].z = 3.0f;
    Scene wall;
    Material paint;
    wall.materials.push_back(paint);
    Mesh plane;
    for (const glm::vec2 corner : {glm::vec2(-9, -9), glm::vec2(9, -9), glm::vec2(9, 9), glm::vec2(-9, 9)}) {
        plane.positions.push_back(glm::vec3(corner, 3.0f - float(kDepth)));
        plane.normals.push_back(glm::vec3(0.0f, 0.0f, 1.0f));
    }
    plane.triangles = {{0, 1, 2}, {0, 2, 3}};
    wall.meshes.push_back(plane);
    wall.objects.emplace_back();
    EXPECT_EQ(append_objects(scene, wall, glm::mat4(1.0f)), 1);
    const Image flow = refractive_flow(paths_of(SurfaceTracer(scene).trace(camera, {.width = kSize, .height = kSize})),
                                       camera, kSize, kSize);
    const double pixels = kSize / (2.0 * std::tan(0.5 * double(camera.vertical_fov)));
    for (std::uint32_t x = 0; x < kSize; ++x) {
        const std::uint32_t y = kSize / 3;
        const double px = (x + 0.5 - 0.5 * kSize) / pixels, py = (0.5 * kSize - y - 0.5) / pixels;
        const double tan_a = std::hypot(px, py), sin_b = std::sin(std::atan(tan_a)) / 1.5;
        const double shift = kThick * (tan_a - std::tan(std::asin(sin_b)));  // towards the axis, m
        const double share = -shift / kDepth * pixels / tan_a;
        const float* found = flow.at(int(x), int(y));
        EXPECT_NEAR(found[0], share * px, 2e-3);
        EXPECT_NEAR(found[1], -share * py, 2e-3);
        EXPECT_EQ(found[2], 1.0f);
    }
}

TEST(RefractiveFlow, EndsBehindTheCameraAreNotValid) {
    RefractedPath away, back, cut, none;
    away.events = back.events = cut.events = 2;
    away.direction = cut.direction = glm::vec3(0.0f, 0.0f, -1.0f);
    back.direction = glm::vec3(0.0f, 0.0f, 1.0f);
    cut.status = Status::kEventLimit;
    const Image flow = refractive_flow(std::vector{away, back, cut, none}, Camera{}, 2, 2);
    EXPECT_EQ(flow.at(0, 0)[0], 0.5f);
    EXPECT_EQ(flow.at(0, 0)[1], 0.5f);
    EXPECT_EQ(flow.at(0, 0)[2], 1.0f);
    EXPECT_EQ(flow.at(1, 0)[2], 0.0f);
    EXPECT_EQ(flow.at(0, 1)[2], 0.0f);
    EXPECT_EQ(flow.at(1, 1)[2], 1.0f);
    EXPECT_EQ(flow.at(1, 1)[0], 0.0f);
    EXPECT_THROW(refractive_flow(std::vector{away}, Camera{}, 2, 2), Error);
}

TEST(CombinedScenes, ObjectsKeepTheirMeshesMaterialsAndImages) {
    Scene scene = load_scene("shape:sphere"), added = load_scene("shape:torus");
    added.images.emplace_back(1, 1, 3);
    added.image_names.emplace_back("dot");
    added.materials[0].base_color_texture.image = 0;
    added.objects[0].body = 0;
    scene.objects[0].body = 4;
    glm::mat4 moved(1.0f);
    moved[3].x = 5.0f;
    scene.images.emplace_back(1, 1, 3);
    scene.image_names.emplace_back("other");
    EXPECT_EQ(append_objects(scene, added, moved), 1);
    ASSERT_EQ(scene.objects.size(), 2u);
    const Object& object = scene.objects[1];
    EXPECT_EQ(scene.meshes[std::size_t(object.mesh)].positions, added.meshes[0].positions);
    EXPECT_EQ(scene.materials[std::size_t(object.material)].base_color_texture.image, 1);
    EXPECT_EQ(scene.materials[0].base_color_texture.image, -1);
    EXPECT_EQ(object.body, 5);
    EXPECT_EQ(object.world_from_object[3].x, 5.0f);
}

/// Flow of random scenes against the paths of the exact tracer, projected by a pinhole matrix.
TEST(RefractiveFlow, OfDataSetsAgreesWithTheExactTracer) {
    cli::Recipe recipe;
    recipe.seed = 11;
    const cli::DatasetScenes scenes(recipe);
    const ExactSettings settings{.width = kSize, .height = kSize},
        shifted{.width = kSize, .height = kSize, .shift_px = {0.01, 0.0}};
    std::size_t stable = 0, glass = 0, near = 0, nearest = 0;
    for (int number = 0; number < 8; ++number) {
        const cli::DatasetScene made = scenes.make(std::uint64_t(number));
        const Image flow = refractive_flow(paths_of(SurfaceTracer(made.scene).trace(made.camera, settings)),
                                           made.camera, kSize, kSize);
        const Tracer tracer(made.scene);
        const std::vector<RefractedPath> exact = tracer.exact(made.camera, settings),
                                         moved = tracer.exact(made.camera, shifted);
        const double focal = 0.5 * kSize / std::tan(0.5 * double(made.camera.vertical_fov));
        const glm::dmat3 axes(made.camera.world_from_view);
        const dvec3 eye(made.camera.world_from_view[3]);
        const auto pixel_of = [&](const RefractedPath& path) {
            const dvec3 to = path.object >= 0 ? dvec3(path.position) - eye : dvec3(path.direction);
            const double depth = -glm::dot(to, axes[2]);
            return 0.5 * kSize + focal / depth * glm::dvec2(glm::dot(to, axes[0]), -glm::dot(to, axes[1]));
        };
        for (std::size_t i = 0; i < exact.size(); ++i) {
            const glm::vec2 center(float(i % kSize) + 0.5f, float(i / kSize) + 0.5f);
            const float* found = &flow.pixels[3 * i];
            if (exact[i].events == 0 || found[2] == 0.0f) continue;
            ++glass;
            const glm::dvec2 wanted = pixel_of(exact[i]);
            if (moved[i].events == 0 || moved[i].object != exact[i].object ||
                !(glm::distance(wanted, pixel_of(moved[i])) < 1.0))
                continue;
            ++stable;
            const double error = glm::distance(wanted - glm::dvec2(center), glm::dvec2(found[0], found[1]));
            near += error < 0.5 ? 1 : 0;
            nearest += error < 0.1 ? 1 : 0;
        }
    }
    RecordProperty("stable_share", std::to_string(double(stable) / double(glass)));
    std::printf("%zu pixels of glass, %zu stable, %zu within 0.5 px, %zu within 0.1 px\n", glass, stable, near,
                nearest);
    EXPECT_GT(stable, 3000u);
    EXPECT_GE(double(near), 0.99 * double(stable));
    EXPECT_GE(double(nearest), 0.95 * double(stable));
}

TEST(DatasetScenes, DependOnTheSeedAndTheNumberOnly) {
    cli::Recipe recipe;
    const cli::DatasetScene a = cli::DatasetScenes(recipe).make(7), b = cli::DatasetScenes(recipe).make(7);
    const cli::DatasetScene other = cli::DatasetScenes(recipe).make(8);
    recipe.seed = 2;
    const cli::DatasetScene seeded = cli::DatasetScenes(recipe).make(7);
    EXPECT_EQ(a.camera.world_from_view, b.camera.world_from_view);
    EXPECT_EQ(a.background.images[0].pixels, b.background.images[0].pixels);
    EXPECT_NE(a.camera.world_from_view, other.camera.world_from_view);
    EXPECT_NE(a.camera.world_from_view, seeded.camera.world_from_view);
}

TEST(DatasetScenes, ObjectsDoNotTouch) {
    cli::Recipe recipe;
    recipe.count = {6, 6};
    recipe.spread_m = 0.01;
    const cli::DatasetScene made = cli::DatasetScenes(recipe).make(0);
    ASSERT_EQ(made.placed.size(), 6u);
    for (const cli::PlacedSource& a : made.placed)
        for (const cli::PlacedSource& b : made.placed)
            if (&a != &b) {
                EXPECT_GT(glm::distance(a.position, b.position),
                          std::max({a.half_size.x, a.half_size.y, a.half_size.z}) +
                              std::max({b.half_size.x, b.half_size.y, b.half_size.z}));
            }
}

}  // namespace
}  // namespace pellucid
