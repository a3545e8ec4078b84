// Photons in volumes, and through boundaries of rough solids that part nothing.
#include "built_volumes.h"
#include "closed_form/lights.h"
#include "path_pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace pellucid {
namespace {

using namespace test;

Mesh ball_at(glm::vec3 center, float radius) {
    Mesh mesh = load_scene("shape:sphere,segments=48").meshes[0];
    for (glm::vec3& position : mesh.positions) position = center + radius * glm::normalize(position);
    return with_flat_normals(mesh);
}

/// A box of 8 m, black inside and open to light from outside.
void add_black_box(Scene& scene) {
    Material black = matt(0.0f);
    black.double_sided = false;
    add(scene, with_flat_normals(inside_out(cube(8.0f))), black);
}

/// m2 that a convex mesh hides of what is below it.
double shadow_of(const Mesh& mesh) {
    double area = 0.0;
    for (const glm::uvec3 t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        area += std::max(0.5 * glm::cross(b - a, c - a).y, 0.0);
    }
    return area;
}

TEST(PhotonsInVolumes, ABlackBoxGetsWhatAVolumeLeavesAndAllThatMeetsGlass) {
    // The sun shines straight down on a cube of 2 m and, beside it, on a ball of clear glass.
    const Mesh ball = ball_at({2.9f, 0, 2.9f}, 1.0f);
    Scene scene = scene_of(ball, glass());
    add_black_box(scene);
    const glm::vec3 absorption(0.0f, 0.25f, 0.5f), scattering(0.0f, 0.0f, 0.5f);
    Volume volume = even(absorption, glm::vec3(0.0f));
    volume.sigma_s.assign(volume.voxel_count(), scattering);
    add_volume(scene, std::move(volume));
    scene.lights = {sun({0, -1, 0}, 3.0f)};
    const glm::dvec3 photons = Tracer(scene).light_flux(2000000)[1].photons;
    // A hundredth also covers what the ball throws back and the volume then absorbs: less than 0.3%.
    for (int c = 0; c < 3; ++c) {
        const double expected = 3.0 * (4 * std::exp(-2.0 * double(absorption[c] + scattering[c])) + shadow_of(ball));
        EXPECT_NEAR(photons[c], expected, 0.01 * expected) << c;
    }
}

TEST(PhotonsInVolumes, NoLightOfALampIsLostInAnIndexThatVaries) {
    Scene scene = scene_of(ball_at({2.4f, 0.5f, 0}, 1.0f), glass());
    add_black_box(scene);
    add(scene, ball_at({0, 0, 0}, 0.4f), matt(0.0f));
    add_volume(scene, graded_ball(1.3f, 0.1f));
    for (const glm::vec3 at : {glm::vec3(0.2f, 2.3f, 0.4f), glm::vec3(0.5f, 0.3f, -0.4f)}) {
        SCOPED_TRACE(at.y > 1.0f ? "outside of the volume" : "in the volume");
        scene.lights = {lamp(at, 3.0f, 0.1f)};
        glm::dvec3 direct(0.0), photons(0.0);
        for (const LightFlux& flux : Tracer(scene).light_flux(100000)) direct += flux.direct, photons += flux.photons;
        const double emitted = 4.0 * glm::pi<double>() * 3.0;
        EXPECT_NEAR(direct.g + photons.g, emitted, 0.01 * emitted);
        EXPECT_GT(photons.g, 0.1 * emitted);
    }
}

TEST(PhotonsInVolumes, AFloorShowsWhatTheVolumeAboveItLeaves) {
    Scene scene = scene_of(floor_at(-1.5f, 1.5f), matt(0.5f));
    add_volume(scene, even(glm::vec3(0.3f), glm::vec3(0.0f)));
    scene.lights = {sun({0, -1, 0}, 3.0f)};
    const Camera below = parallel_camera({0, -1.5f, 0}, glm::normalize(glm::vec3(1, -1, 0.2f)), 0.5f, 0.6f);
    const double expected = 0.5 / glm::pi<double>() * 3.0 * std::exp(-2 * 0.3);
    EXPECT_NEAR(mean_of(trace_picture(scene, below, 0.0f, 8, 200, 10000)).radiance, expected, 0.02 * expected);
    EXPECT_EQ(mean_of(trace_picture(scene, below, 0.0f, 8, 10)).radiance, 0.0) << "a stated limit without photons";
}

/// Rough glass in rough glass of the same index: the inner boundary parts nothing.
Scene nested_balls() {
    Material rough = glass();
    rough.roughness = 0.5f;
    Scene scene = scene_of(load_scene("shape:sphere,segments=64").meshes[0], rough);
    add(scene, scene.meshes[0], rough, glm::scale(glm::mat4(1.0f), glm::vec3(0.5f)));
    return scene;
}

TEST(NullBoundaries, ALampWithinSendsOutAllItsLight) {
    // By symmetry every direction sees the lamp's intensity, as the integral of radiance over the ball's disc. Photons lie
    // in flat discs, which miss less than 1% of a curved surface at its rim.
    Scene scene = nested_balls();
    const float extent = 2.2f * scene_bounds(scene).half_size.x;
    const Camera camera = parallel_camera(glm::vec3(0), {0, 0, -1}, extent);
    const auto expect_all = [&](const Scene& of, std::uint32_t samples, std::uint32_t photons) {
        const Seen seen = mean_of(trace_picture(of, camera, 0.0f, 16, samples, photons));
        const double area = double(extent * extent);
        EXPECT_NEAR(area * seen.radiance, 3.0, 4.0 * area * seen.error + 0.03);
        EXPECT_LT(area * seen.error, 0.08);
    };
    scene.lights = {lamp(glm::vec3(0), 3.0f)};
    expect_all(scene, 100, 5000);
    scene.lights[0].radius = 0.1f;
    expect_all(scene, 1000, 0);  // met by chance
    Material mirror = matt(1.0f);
    mirror.metallic = 1.0f;
    mirror.roughness = 0.0f;
    add(scene, floor_at(0.0f, 0.1f), mirror, glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, -3)));  // out of sight
    expect_all(scene, 100, 5000);
}

TEST(NullBoundaries, LightFromOutsideCountsOnce) {
    Scene scene = nested_balls();
    const float radius = scene_bounds(scene).half_size.x;
    add(scene, scene.meshes[0], matt(0.6f), glm::scale(glm::mat4(1.0f), glm::vec3(0.25f)));
    scene.lights = {lamp(radius * glm::vec3(1.5f, 2, 1), 3.0f, 0.3f * radius)};
    const Camera camera = parallel_camera(glm::vec3(0), {0, 0, -1}, 2.2f * radius, 1.5f * radius);
    const Seen by_photons = mean_of(trace_picture(scene, camera, 0.0f, 16, 400, 5000));
    const Seen by_chance = mean_of(trace_picture(scene, camera, 0.0f, 16, 2000));
    EXPECT_GT(by_chance.radiance, 0.0);
    EXPECT_NEAR(by_photons.radiance, by_chance.radiance, 4 * std::hypot(by_photons.error, by_chance.error));
}

}  // namespace
}  // namespace pellucid
