// Light that arrives on objects, before any kernel and through kernels; the parts of a picture.
#include "core/math.h"
#include "test_files.h"
#include "traced_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace pellucid {
namespace {

using namespace test;

constexpr double kPiD = 3.14159265358979323846;

Light lamp(glm::vec3 position, float radius) {
    Light light;
    light.position = position;
    light.radius = radius;
    light.intensity = {3.0f, 2.0f, 1.0f};
    return light;
}

Light sun_above(float irradiance = 1.0f) {
    Light light;
    light.kind = Light::Kind::kDirectional;
    light.direction = {0, -1, 0};
    light.intensity = glm::vec3(irradiance);
    light.angular_diameter = 0.0f;
    return light;
}

/// A lamp beside glass that does not absorb, with facet normals, in a closed black box: the box gets all its light.
void expect_all_light_on_the_box(Mesh mesh, const char* name) {
    SCOPED_TRACE(name);
    Scene scene = scene_of(with_flat_normals(mesh), glass());
    const Bounds bounds = scene_bounds(scene);
    const float size = 6.0f * bounds.radius;
    Material black = matt(0.0f);
    black.double_sided = false;
    add(scene, with_flat_normals(inside_out(cube(size, bounds.center))), black);
    scene.lights = {lamp(bounds.center + bounds.radius * glm::vec3(1.2f, 1.0f, 0.4f), 0.1f * bounds.radius)};
    const std::vector<LightFlux> flux = Tracer(scene).light_flux(400000);
    EXPECT_EQ(flux[0].direct, glm::dvec3(0.0));
    EXPECT_EQ(flux[0].photons, glm::dvec3(0.0));
    for (int c = 0; c < 3; ++c) {
        const double emitted = 4.0 * kPiD * double(scene.lights[0].intensity[c]);
        EXPECT_NEAR(flux[1].direct[c] + flux[1].photons[c], emitted, 0.01 * emitted);
        EXPECT_GT(flux[1].photons[c], 0.02 * emitted);
    }
    const double emitted = 4.0 * kPiD * 3.0;
    std::printf("%s: shadow rays %.4f + photons %.4f of what the lamp emits\n", name, flux[1].direct.r / emitted,
                flux[1].photons.r / emitted);
}

TEST(LightFlux, ABlackBoxGetsAllLightAroundGlass) {
    for (const char* shape : {"shape:sphere,segments=24", "shape:goblet,segments=32,rings=40"})
        expect_all_light_on_the_box(load_scene(shape).meshes[0], shape);
}

TEST(LightFlux, ABlackBoxGetsAllLightAroundTheBunny) {
    const std::filesystem::path bunny = data_folder() / "models" / "bunny_closed_69664.obj";
    if (!std::filesystem::exists(bunny)) GTEST_SKIP() << "PELLUCID_TEST_DATA names no folder with " << bunny.filename();
    expect_all_light_on_the_box(load_scene(bunny.string()).meshes[0], "bunny");
}

TEST(LightFlux, ALargeLampSendsPhotonsFromAllOfItsBall) {
    // Glass of index 1 reflects nothing back to the lamp, and passes on what a black ball in its place would get.
    Scene scene = scene_of(with_flat_normals(load_scene("shape:sphere,segments=24").meshes[0]), glass(1.0f));
    const float radius = scene_bounds(scene).half_size.x;
    Material black = matt(0.0f);
    black.double_sided = false;
    add(scene, with_flat_normals(inside_out(cube(12.0f * radius))), black);
    scene.lights = {lamp({2.7f * radius, 0, 0}, 1.5f * radius)};
    const double photons = Tracer(scene).light_flux(1000000)[1].photons.r;
    scene.materials[0] = matt(0.0f);
    const double expected = Tracer(scene).light_flux(0)[0].direct.r;
    EXPECT_NEAR(photons, expected, 0.01 * expected);
}

/// Mean radiance of a picture of 16 x 16 pixels by one sample each, over `rounds` seeds.
double first_rounds(const Scene& scene, const Camera& camera, std::uint32_t photons, std::uint32_t rounds) {
    double sum = 0.0;
    const Tracer tracer(scene);
    for (std::uint32_t seed = 1; seed <= rounds; ++seed) {
        const PathTracedImage image = tracer.path_trace(
            camera, uniform(0.0f), {.width = 16, .height = 16, .samples = 1, .seed = seed, .photons = photons});
        for (const float value : image.radiance.pixels) sum += double(value) / double(image.radiance.pixels.size());
    }
    return sum / rounds;
}

/// Under a plate of 4 m that the sun shines through straight down, radiance of a floor with that albedo.
Scene below_a_plate(Mesh floor, float albedo) {
    Mesh plate = with_flat_normals(cube(4.0f, {0, 4, 0}));
    Scene scene = scene_of(plate, glass());
    scene.lights = {sun_above()};
    add(scene, floor, matt(albedo));
    return scene;
}
constexpr double kThroughPlate = 2 * 1.5 / (1.5 * 1.5 + 1);

TEST(LightFlux, KernelsKeepTheirLightOnSmallReceivers) {
    // The disc of the first round is as wide as half the receiver.
    const Scene scene = below_a_plate(floor_at(0.0f, 0.5f), 0.02f);
    const Camera above = parallel_camera(glm::vec3(0), {0, -1, 0}, 1.0f, 1.0f);
    const double expected = 0.02 / kPiD * kThroughPlate;
    EXPECT_NEAR(first_rounds(scene, above, 4000, 200), expected, 0.02 * expected);
}

TEST(LightFlux, KernelsKeepTheirLightBeforeAWall) {
    // The floor goes on behind the wall, in the dark.
    Scene scene = below_a_plate(floor_at(0.0f, 5.0f), 0.02f);
    add(scene, floor_at(0.0f, 1.0f), matt(0.0f),
        glm::translate(glm::mat4(1.0f), glm::vec3(0.2f, 0, 0)) *
            glm::rotate(glm::mat4(1.0f), 0.5f * kPi, glm::vec3(0, 0, 1)));
    add(scene, floor_at(0.9f, 2.5f), matt(0.0f), glm::translate(glm::mat4(1.0f), glm::vec3(2.7f, 0, 0)));
    const double expected = 0.02 / kPiD * kThroughPlate;
    const Camera before = parallel_camera({-0.05f, 0, 0}, {0, -1, 0}, 0.5f, 0.8f);
    EXPECT_NEAR(first_rounds(scene, before, 4000, 200), expected, 0.03 * expected);
}

PathTracedImage parts_of(const Scene& scene, const Camera& camera, float sky, std::uint32_t samples) {
    return Tracer(scene).path_trace(camera, uniform(sky),
                                    {.width = 16, .height = 16, .samples = samples, .photons = 5000, .parts = true});
}
double mean_of_part(const PathTracedImage& image, std::size_t part) {
    double sum = 0.0;
    for (const float value : image.parts[part].pixels) sum += double(value);
    return sum / double(image.parts[part].pixels.size());
}

TEST(LightParts, AddUpToThePicture) {
    Scene scene = load_scene("shape:sphere,segments=32");
    add(scene, floor_at(-1.2f, 3.0f), matt({0.8f, 0.5f, 0.2f}));
    Material mirror = matt(0.9f);
    mirror.metallic = 1.0f;
    mirror.roughness = 0.0f;
    add(scene, floor_at(-1.1f, 0.5f), mirror, glm::translate(glm::mat4(1.0f), glm::vec3(1.5f, 0, 0.5f)));
    scene.lights = {lamp({1, 3, 0}, 0.3f)};
    const PathTracedImage image = parts_of(scene, orbit_camera(scene_bounds(scene), 20, 30, 3.0f, 0.6f), 0.3f, 20);
    for (std::size_t i = 0; i < image.radiance.pixels.size(); ++i) {
        float sum = 0.0f;
        for (const Image& part : image.parts) sum += part.pixels[i];
        EXPECT_NEAR(sum, image.radiance.pixels[i], 1e-5f * (1.0f + sum));
    }
    for (std::size_t part = 0; part < 4; ++part) EXPECT_GT(mean_of_part(image, part), 1e-4) << kLightParts[part];
}

TEST(LightParts, AreWhatTheirNotationSays) {
    const Camera above = parallel_camera(glm::vec3(0), {0, -1, 0}, 0.5f, 1.5f);
    const double lit = 0.1 / kPiD;
    const auto expect_parts = [&](const Scene& scene, float sky, std::array<double, 4> expected) {
        const PathTracedImage image = parts_of(scene, above, sky, 400);
        for (std::size_t part = 0; part < 4; ++part)
            EXPECT_NEAR(mean_of_part(image, part), expected[part], 0.03 * expected[part] + 1e-6) << kLightParts[part];
    };
    Scene floor = scene_of(floor_at(0.0f, 4.0f), matt(0.1f));
    floor.lights = {sun_above()};
    expect_parts(floor, 0.0f, {0, lit, 0, 0});
    expect_parts(floor, 0.5f, {0, lit + 0.1 * 0.5, 0, 0});
    floor.materials[0].emission = glm::vec3(0.25f);
    expect_parts(floor, 0.0f, {0.25, lit, 0, 0});
    // Seen in a smooth pane below the eye it is what it was, weaker.
    Scene below_glass = scene_of(floor_at(0.0f, 4.0f), matt(0.1f));
    below_glass.lights = {sun_above()};
    Mesh plate = with_flat_normals(cube(8.0f));
    for (glm::vec3& position : plate.positions) position.y = position.y > 0.0f ? 2.5f : 2.0f;
    add(below_glass, plate, glass());
    const PathTracedImage image = parts_of(below_glass, above, 0.0f, 400);
    EXPECT_NEAR(mean_of_part(image, 1), 0.0, 1e-6) << "no straight light";
    EXPECT_NEAR(mean_of_part(image, 2), lit * kThroughPlate, 0.03 * lit) << "refracted light is a caustic";
    EXPECT_GT(mean_of_part(image, 3), 0.0) << "from the floor to the plate and back";
    EXPECT_LT(mean_of_part(image, 3), 0.02 * lit);
}

TEST(LightParts, LightsWithoutASizeAreMissedWithoutPhotons) {
    Scene scene = load_scene("shape:sphere,segments=16");
    scene.lights = {sun_above(), lamp({1, 3, 0}, 0.0f), lamp({1, 3, 0}, 0.1f)};
    scene.lights[0].name = "noon";
    scene.lights[1].name = "bulb";
    const auto warnings = [&](std::uint32_t photons) {
        return Tracer(scene)
            .path_trace(view_of(scene, 0), uniform(1.0f), {.width = 4, .height = 4, .samples = 1, .photons = photons})
            .warnings;
    };
    ASSERT_EQ(warnings(0).size(), 1u);
    EXPECT_NE(warnings(0)[0].find("2 lights"), std::string::npos) << warnings(0)[0];
    EXPECT_NE(warnings(0)[0].find("(noon, bulb)"), std::string::npos) << warnings(0)[0];
    EXPECT_TRUE(warnings(100).empty());
    scene.materials[0].roughness = 0.5f;
    EXPECT_TRUE(warnings(0).empty()) << "rough glass is aimed through";
}

}  // namespace
}  // namespace pellucid
