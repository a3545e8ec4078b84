// Lights with a size in the path tracer: closed forms, furnaces, and each kind of path by two methods.
#include "core/math.h"
#include "path_pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace pellucid {
namespace {

using namespace test;

Light ball_lamp(glm::vec3 position, float radius, float radiance = 1.0f) {
    Light light;
    light.position = position;
    light.radius = radius;
    light.intensity = glm::vec3(radiance * kPi * radius * radius);
    return light;
}

Light disc_sun(glm::vec3 direction, float angular_diameter, float irradiance = 3.0f) {
    Light light;
    light.kind = Light::Kind::kDirectional;
    light.direction = glm::normalize(direction);
    light.angular_diameter = angular_diameter;
    light.intensity = glm::vec3(irradiance);
    return light;
}

constexpr glm::vec3 kDown(0, -1, 0);

TEST(LightSizes, ABallLightsAFloorAsALampInItsCentreDoes) {
    // Of a ball that is all above the horizon the irradiance is pi L sin^2 of half its angle, as far off as near.
    Scene scene = scene_of(floor_at(0.0f), matt(0.5f));
    scene.lights = {ball_lamp({0, 2, 0}, 0.7f)};
    const double intensity = double(scene.lights[0].intensity.g);
    const glm::vec3 aside = glm::normalize(glm::vec3(1, -0.5f, 0));  // past the lamp
    expect_seen(look(scene, {0, 0, 0}, aside, 4000), 0.5 / glm::pi<double>() * intensity / 4);
    expect_seen(look(scene, {1.5f, 0, 0}, aside, 4000), 0.5 / glm::pi<double>() * intensity / 6.25 * (2 / 2.5));
}

TEST(LightSizes, ASunsShadowHasAPenumbra) {
    // An edge at height 2 hides a segment of the sun's disc.
    Scene scene = scene_of(floor_at(0.0f), matt(0.5f));
    Mesh half_plane = floor_at(2.0f);
    for (glm::vec3& position : half_plane.positions) position.x = std::max(position.x, 0.0f);
    add(scene, half_plane, matt(0.0f));
    const float diameter = 0.2f;
    scene.lights = {disc_sun(kDown, diameter)};
    const double widest = 2 * std::tan(double(diameter) / 2), lit = 0.5 / glm::pi<double>() * 3;
    for (const double x : {-0.9, -0.5, 0.0, 0.3, 0.8}) {
        SCOPED_TRACE(x);
        const double visible = (std::acos(x) - x * std::sqrt(1 - x * x)) / glm::pi<double>();
        const glm::vec3 along_the_edge = glm::normalize(glm::vec3(0, -0.1f, 1));
        const Seen seen = look(scene, {float(x * widest), 0, 0}, along_the_edge, 20000, 5.0f);
        EXPECT_NEAR(seen.radiance, lit * visible, 4.0 * seen.error + 0.005 * lit);
    }
}

TEST(LightSizes, LightsAreSeenDirectlyReflectedAndRefracted) {
    const double radiance = 7.0, half = 0.05;
    const double sun_irradiance = radiance * 2 * glm::pi<double>() * (1 - std::cos(half));
    const double reflects = 0.04, through = 2 * 1.5 / (1.5 * 1.5 + 1);
    Material mirror = matt(1.0f);
    mirror.metallic = 1.0f;
    mirror.roughness = 0.0f;
    for (const bool sun : {true, false}) {
        SCOPED_TRACE(sun ? "sun" : "lamp");
        Scene scene = scene_of(floor_at(-3.0f, 0.1f), matt(0.0f));
        scene.lights = {sun ? disc_sun(kDown, float(2 * half), float(sun_irradiance))
                            : ball_lamp({0, 20, 0}, 1.0f, float(radiance))};
        const glm::vec3 up = -kDown;
        expect_seen(look(scene, {0, 0, 0}, up, 1, 1.0f), radiance);
        expect_seen(look(scene, {2, 0, 0}, up, 1, 1.0f), sun ? radiance : 0.0);
        expect_seen(look(scene, {0, 0, 0}, glm::normalize(glm::vec3(0.06f, 1, 0)), 1, 1.0f), 0.0);
        Scene reflected = scene;
        add(reflected, floor_at(0.0f), mirror);
        expect_seen(look(reflected, {0, 0, 0}, kDown, 1, 1.0f), radiance);
        add(reflected, floor_at(0.1f), glass());
        reflected.materials.back().thickness = 0.0f;
        const double pane = 2 * reflects / (1 + reflects);  // and again, between pane and mirror
        expect_seen(look(reflected, {0, 0, 0}, kDown, 20000, 1.0f),
                    radiance * (pane + (1 - pane) * (1 - pane) / (1 - pane)));
        Scene refracted = scene;
        add(refracted, with_flat_normals(cube()), glass());
        expect_seen(look(refracted, {0, -1, 0}, up, 20000, 1.0f), radiance * through);
    }
}

/// The design's furnace: a picture that is 1 everywhere.
void expect_furnace(const PathTracedImage& image) {
    int beyond = 0;
    double farthest = 0.0;
    const std::size_t pixels = image.radiance.pixels.size() / 3;
    for (std::size_t i = 0; i < pixels; ++i) {
        const double off = std::abs(double(image.radiance.pixels[3 * i + 1]) - 1.0);
        const double error = std::max(double(image.standard_error.pixels[3 * i + 1]), 1e-5);
        beyond += off > 4.0 * error ? 1 : 0;
        farthest = std::max(farthest, off / error);
    }
    EXPECT_LE(beyond, std::max(1.0, 2e-4 * double(pixels)));
    EXPECT_LE(farthest, 6.0);
    EXPECT_NEAR(mean_of(image).radiance, 1.0, 1e-3);
}

/// Of albedo `a`, all the same bright in a furnace.
Material gray(float a) {
    Material material = matt(a);
    material.emission = glm::vec3(1.0f - a);
    return material;
}

/// Clear, rough and thin glass on a gray floor, a gray ball in glass.
Scene furnace_things() {
    const Mesh ball = load_scene("shape:sphere,segments=24").meshes[0];
    const auto at = [](glm::vec3 place, float size) {
        return glm::scale(glm::translate(glm::mat4(1.0f), place), glm::vec3(size));
    };
    Scene scene = scene_of(floor_at(-1.0f, 6.0f), gray(0.6f));
    add(scene, ball, glass(), at({-1.2f, 0, 0}, 0.9f));
    add(scene, ball, gray(0.3f), at({-1.2f, 0, 0}, 0.4f));
    scene.materials.back().emission *= 2.25f;  // in glass light is n^2 times as strong
    add(scene, ball, glass(), at({1.2f, 0, 0}, 0.9f));
    scene.materials.back().roughness = 0.5f;
    add(scene, floor_at(0.0f, 1.0f), glass(), glm::translate(glm::mat4(1.0f), glm::vec3(0, 1.5f, 0.5f)));
    scene.materials.back().thickness = 0.0f;
    return scene;
}

const Camera kFurnaceView = parallel_camera({0, 0, 0}, glm::normalize(glm::vec3(0.2f, -0.6f, -1)), 4.5f);

TEST(LightSizes, LampsOfRadianceOneAreInvisibleInTheFurnace) {
    Scene scene = furnace_things();
    scene.lights = {ball_lamp({0, 1, 0}, 0.3f), ball_lamp({1.2f, 2, 0.5f}, 0.5f), ball_lamp({-0.3f, -0.7f, 1}, 0.2f),
                    ball_lamp({1.2f, 0, 0}, 0.3f)};
    scene.lights[3].intensity *= 2.25f;  // in glass
    // Fewer samples understate the error of rough glass under what is aimed at near by.
    expect_furnace(trace_picture(scene, kFurnaceView, 1.0f, 24, 1600));
}

TEST(LightSizes, TwoHalvesOfTheSkyAreAFurnace) {
    Scene scene = furnace_things();
    const float nearly_pi = kPi - 1e-5f;
    scene.lights = {disc_sun({0.3f, -1, 0.2f}, nearly_pi, 2 * kPi), disc_sun({-0.3f, 1, -0.2f}, nearly_pi, 2 * kPi)};
    expect_furnace(trace_picture(scene, kFurnaceView, 0.0f, 32, 400));
}

TEST(LightSizes, PhotonsKeepTheFurnacesMean) {
    Scene scene = furnace_things();
    scene.lights = {ball_lamp({0, 1, 0}, 0.3f), ball_lamp({1.2f, 2, 0.5f}, 0.5f)};
    EXPECT_NEAR(mean_of(trace_picture(scene, kFurnaceView, 1.0f, 24, 200, 20000)).radiance, 1.0, 5e-3);
}

/// Tinted glass with a texture and an opaque thing inside, above a floor, beside it a rough metal wall; lit by a ball of radius 0.3.
Scene lit_things(bool with_glass) {
    const Mesh ball = load_scene("shape:sphere,segments=32").meshes[0];
    Scene scene = scene_of(floor_at(-1.0f, 2.5f), matt({0.7f, 0.5f, 0.3f}));
    Material metal = matt({0.9f, 0.7f, 0.4f});
    metal.metallic = 1.0f;
    metal.roughness = 0.4f;
    add(scene, floor_at(0.0f, 2.0f), metal,
        glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, -2)) *
            glm::rotate(glm::mat4(1.0f), 0.5f * kPi, glm::vec3(1, 0, 0)));
    if (!with_glass) return scene;
    Image stripes(4, 1, 3);
    for (int x = 0; x < 4; ++x)
        for (int c = 0; c < 3; ++c) stripes.at(x, 0)[c] = x % 2 == 0 ? 1.0f : 0.3f;
    scene.images = {stripes};
    scene.image_names = {"stripes"};
    Material tinted = glass();
    tinted.base_color = {0.9f, 1.0f, 0.8f, 1.0f};
    tinted.base_color_texture.image = 0;
    tinted.attenuation_color = {0.5f, 0.8f, 0.9f};
    tinted.attenuation_distance = 1.0f;
    Mesh block = with_flat_normals(cube(1.2f));
    block.texcoords[0].resize(block.positions.size());
    for (std::size_t i = 0; i < block.positions.size(); ++i)
        block.texcoords[0][i] = {block.positions[i].x + 0.5f, block.positions[i].z};
    add(scene, block, tinted, glm::rotate(glm::mat4(1.0f), 0.3f, glm::vec3(0, 1, 0)));
    add(scene, ball, matt(0.6f), glm::scale(glm::mat4(1.0f), glm::vec3(0.25f)));
    return scene;
}

/// Seen from above, past the ball, so that no pixel shows it.
const Camera kLitView = parallel_camera({0, -0.5f, -0.5f}, glm::normalize(glm::vec3(-0.8f, -1, -0.4f)), 3.0f);
const Light kLitBy = ball_lamp({0.6f, 1.6f, -0.8f}, 0.3f);

/// The same ball as an unlit mesh: paths meet it by chance alone.
Scene with_mesh_lamp(Scene scene) {
    Material emits;
    emits.unlit = true;
    add(scene, load_scene("shape:sphere,segments=96").meshes[0], emits,
        glm::scale(glm::translate(glm::mat4(1.0f), glm::vec3(kLitBy.position)), glm::vec3(0.3f)));
    return scene;
}

TEST(LightSizes, AimingAtALampIsMeetingItByChance) {
    Scene scene = lit_things(false);
    const Seen by_chance = mean_of(trace_picture(with_mesh_lamp(scene), kLitView, 0.0f, 16, 6000));
    scene.lights = {kLitBy};
    const Seen aimed = mean_of(trace_picture(scene, kLitView, 0.0f, 16, 2000));
    EXPECT_LT(by_chance.error, 0.003 * by_chance.radiance);
    EXPECT_NEAR(aimed.radiance, by_chance.radiance, 4 * std::hypot(aimed.error, by_chance.error));
}

/// Mean caustic, and mean of all, of lit_things() with glass.
struct Caustic {
    double part, all;
};
Caustic caustic_of(const Scene& scene, std::uint32_t samples, std::uint32_t photons) {
    const PathTracedImage image = Tracer(scene).path_trace(
        kLitView, uniform(0.0f), {.width = 16, .height = 16, .samples = samples, .photons = photons, .parts = true});
    Caustic caustic{0.0, mean_of(image).radiance};
    for (const float value : image.parts[2].pixels) caustic.part += double(value) / (16 * 16 * 3);
    return caustic;
}

TEST(LightSizes, PhotonsBringWhatPathsMeetByChanceBehindGlass) {
    Scene scene = lit_things(true);
    const Caustic by_mesh = caustic_of(with_mesh_lamp(scene), 8000, 0);
    scene.lights = {kLitBy};
    const Caustic by_chance = caustic_of(scene, 8000, 0), by_photons = caustic_of(scene, 400, 10000);
    EXPECT_GT(by_mesh.part, 0.01 * by_mesh.all);
    EXPECT_NEAR(by_chance.part, by_mesh.part, 0.04 * by_mesh.part);
    EXPECT_NEAR(by_photons.part, by_mesh.part, 0.04 * by_mesh.part);
    EXPECT_NEAR(by_chance.all, by_mesh.all, 0.01 * by_mesh.all);
    EXPECT_NEAR(by_photons.all, by_mesh.all, 0.01 * by_mesh.all);
}

TEST(LightSizes, ALampHidesWhatLiesBehindIt) {
    Scene scene = scene_of(floor_at(0.0f), matt(0.5f));
    Light far = ball_lamp({0, 8, 0}, 0.01f, 1e4f), near = ball_lamp({0, 3, 0}, 0.5f, 0.0f);
    scene.lights = {far, near};
    const glm::vec3 aside = glm::normalize(glm::vec3(1, -0.3f, 0));
    EXPECT_EQ(look(scene, {0, 0, 0}, aside, 100).radiance, 0.0) << "black and opaque";
    expect_seen(look(scene, {3, 0, 0}, aside, 100),
                0.5 / glm::pi<double>() * double(far.intensity.g) * 8 / std::pow(73.0, 1.5));
}

}  // namespace
}  // namespace pellucid
