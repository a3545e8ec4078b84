// The path tracer against known answers: furnaces, slabs, lamps over a floor.
#include "core/math.h"
#include "traced_scenes.h"

#include <pellucid/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace pellucid {
namespace {

using namespace test;

Scene load_glass(const char* shape, float ior) {
    LoadOptions options;
    options.ior = ior;
    return load_scene(std::string("shape:") + shape, options);
}

PathTracedImage path_trace(const Scene& scene, const Camera& camera, const Environment& environment, std::uint32_t size,
                           std::uint32_t samples, std::uint32_t seed = 1, std::uint32_t threads = 0) {
    PathTraceSettings settings;
    settings.width = settings.height = size;
    settings.samples = samples;
    settings.seed = seed;
    return Tracer(scene, {.threads = threads}).path_trace(camera, environment, settings);
}

/// What one ray sees: a picture of one pixel, as small as that it shows one place.
struct Seen {
    glm::vec3 radiance, error;
};
Seen look(const Scene& scene, const Environment& environment, glm::vec3 target, glm::vec3 direction,
          std::uint32_t samples) {
    const PathTracedImage image = path_trace(scene, parallel_camera(target, direction, 1e-4f), environment, 1, samples);
    const float *radiance = image.radiance.at(0, 0), *error = image.standard_error.at(0, 0);
    return {{radiance[0], radiance[1], radiance[2]}, {error[0], error[1], error[2]}};
}

void expect_near(const Seen& seen, glm::dvec3 expected, double tolerance = 1e-5) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(seen.radiance[c], expected[c], 4.0 * double(seen.error[c]) + tolerance * (1.0 + expected[c]))
            << "channel " << c;
}

double mean(const Image& image) {
    double sum = 0.0;
    for (const float value : image.pixels) sum += double(value);
    return sum / double(image.pixels.size());
}

constexpr glm::vec3 kDown(0, -1, 0);

TEST(PathTracer, LosslessGlassIsInvisibleInTheFurnace) {
    for (const char* shape : {"sphere,segments=24", "torus,segments=64,sides=32", "knot,segments=128,sides=16",
                              "goblet,segments=48,rings=60", "hollow-sphere,segments=24", "gem", "cube"}) {
        for (const float ior : {1.5f, 2.4f}) {
            SCOPED_TRACE(testing::Message() << shape << " of index " << ior);
            const Scene scene = load_glass(shape, ior);
            const PathTracedImage image = path_trace(scene, view_of(scene, 20), uniform(1.0f), 32, 16);
            // Every path carries 1, or was cut, which counts.
            const double missing = (1.0 - mean(image.radiance)) * 32 * 32 * 16;
            EXPECT_NEAR(missing, double(image.cut_paths), 0.01);
            EXPECT_LE(image.cut_paths, 40u) << "of 16384: trapped by total reflection";
            RecordProperty(std::string(shape) + " cut", std::to_string(image.cut_paths));
            for (std::size_t i = 0; i < image.radiance.pixels.size(); ++i)
                EXPECT_NEAR(image.radiance.pixels[i], 1.0f, std::max(1e-3f, 4 * image.standard_error.pixels[i]));
        }
    }
}

TEST(PathTracer, RoughGlassIsInvisibleInTheFurnace) {
    for (const float roughness : {0.1f, 0.3f, 0.6f, 1.0f}) {
        SCOPED_TRACE(roughness);
        Scene scene = load_scene("shape:sphere,segments=32");
        scene.materials[0].roughness = roughness;
        const PathTracedImage image = path_trace(scene, view_of(scene, 0), uniform(1.0f), 24, 64);
        const double covered = glm::pi<double>() / 4.0 * 0.7 * 0.7;
        const double cut = double(image.cut_paths) / (24 * 24 * 64);
        const double missing = (1.0 - mean(image.radiance) - cut) / covered;
        EXPECT_NEAR(missing, 0.0, 0.002) << "of the light that the glass shows; standard error below 0.0005";
        EXPECT_LE(image.cut_paths, 40u) << "of 36864: trapped by total reflection";
    }
}

TEST(PathTracer, WhiteSurfacesAreInvisibleInTheFurnace) {
    Material coated = matt(glm::vec3(1.0f));
    coated.ior = 1.5f;
    coated.roughness = 0.0f;
    for (const Material& material : {matt(glm::vec3(1.0f)), coated}) {
        Scene scene = load_scene("shape:cube");
        scene.materials[0] = material;
        add(scene, floor_at(-0.6f), material);  // light goes to and fro between the two
        const PathTracedImage image = path_trace(scene, view_of(load_scene("shape:cube"), 30), uniform(1.0f), 16, 256);
        for (std::size_t i = 0; i < image.radiance.pixels.size(); ++i)
            EXPECT_NEAR(image.radiance.pixels[i], 1.0f, 5 * image.standard_error.pixels[i] + 1e-4f);
        EXPECT_NEAR(mean(image.radiance), 1.0, 2e-3);
    }
}

TEST(PathTracer, MetalNeverShinesBrighterThanTheFurnace) {
    for (const float roughness : {0.0f, 0.3f, 0.8f}) {
        Scene scene = scene_of(floor_at(0.0f), matt(glm::vec3(1.0f)));
        scene.materials[0].metallic = 1.0f;
        scene.materials[0].roughness = roughness;
        for (const glm::vec3 direction : {kDown, glm::normalize(glm::vec3(1, -0.3f, 0))}) {
            const Seen seen = look(scene, uniform(1.0f), glm::vec3(0), direction, 2000);
            EXPECT_LE(seen.radiance.g, 1.0f + 4 * seen.error.g);
            EXPECT_GE(seen.radiance.g, roughness < 0.5f ? 0.92f : 0.5f) << "light between facets is lost";
        }
    }
}

TEST(PathTracer, SlabReflectsAndTransmitsAsItsSeriesSays) {
    for (const double ior : {1.5, 2.4}) {
        for (const double absorbed : {0.0, 0.7}) {  // -ln of what is left on one way through
            SCOPED_TRACE(testing::Message() << ior << " " << absorbed);
            Scene scene = load_glass("slab,thickness=0.5", float(ior));
            scene.materials[0].attenuation_color = glm::vec3(float(std::exp(-absorbed)));
            scene.materials[0].attenuation_distance = 0.5f;
            const double r = std::pow((ior - 1) / (ior + 1), 2), a = std::exp(-absorbed);
            const double through = (1 - r) * (1 - r) * a / (1 - r * r * a * a);
            const double back = r + (1 - r) * (1 - r) * r * a * a / (1 - r * r * a * a);
            expect_near(look(scene, two_sides(), glm::vec3(0.1f, 0.1f, 0), {0, 0, -1}, 40000), {through, back, 0});
        }
    }
}

TEST(PathTracer, StacksOfLiquidAndGlass) {
    // Reflectance of one boundary on top of a stack, all reflections between them.
    const auto stacked = [](double top, double stack) {
        return top + (1 - top) * (1 - top) * stack / (1 - top * stack);
    };
    const auto head_on = [](double n_i, double n_t) { return std::pow((n_i - n_t) / (n_i + n_t), 2); };
    const double air_glass = head_on(1, 1.5), glass_water = head_on(1.5, 1.33), water_air = head_on(1.33, 1);
    const auto reflected = [](Mesh mesh) {
        Scene scene = scene_of(with_flat_normals(cube(2.0f)), glass(1.5f));
        add(scene, with_flat_normals(mesh), glass(1.33f));
        return look(scene, two_sides(), {0.03f, 0.05f, 0}, {0, 0, -1}, 40000);
    };
    const double within = stacked(air_glass, stacked(glass_water, stacked(glass_water, air_glass)));
    expect_near(reflected(cube(0.5f)), {1 - within, within, 0});
    // Two solids that touch have one boundary, whichever of its two surfaces is found first.
    const double behind = stacked(water_air, stacked(glass_water, air_glass));
    expect_near(reflected(cube(2.0f, {0, 0, 2})), {1 - behind, behind, 0});
}

TEST(PathTracer, BaseColourTintsOnceWhereLightComesIn) {
    Scene scene = load_scene("shape:slab");
    scene.materials[0].base_color = {0.5f, 1.0f, 0.25f, 1.0f};
    const double r = 0.04;
    const glm::dvec3 base(0.5, 1.0, 0.25);
    // All light that came in leaves in the end, on this side or the other, and was tinted once.
    expect_near(look(scene, uniform(1.0f), glm::vec3(0.1f, 0.1f, 0), {0, 0, -1}, 40000), r + (1 - r) * base);
}

TEST(PathTracer, PaneTransmitsStraightAndMixesWithItsOpaquePart) {
    Material pane = glass();
    pane.thickness = 0.0f;
    pane.base_color = {0.5f, 1.0f, 0.25f, 1.0f};
    const double r = 2 * 0.04 / 1.04;
    const glm::dvec3 base(0.5, 1.0, 0.25), clear = r + (1 - r) * base, opaque = 0.04 + 0.96 * base;
    for (const float transmission : {1.0f, 0.5f}) {
        pane.transmission = transmission;
        const Scene scene = scene_of(floor_at(0.0f), pane);
        expect_near(look(scene, uniform(1.0f), {0.1f, 0, 0.2f}, kDown, 40000),
                    glm::mix(opaque, clear, double(transmission)));
    }
    // Rough, it scatters. It still loses nothing, but reflects by the angles of its facets.
    pane.transmission = 1.0f;
    pane.roughness = 0.2f;
    const Seen rough = look(scene_of(floor_at(0.0f), pane), uniform(1.0f), {0.1f, 0, 0.2f}, kDown, 10000);
    EXPECT_NEAR(rough.radiance.g, 1.0, 1e-3);
    EXPECT_NEAR(rough.radiance.r, clear.r, 0.02);
}

TEST(PathTracer, LampsOverAFloor) {
    const glm::vec3 albedo(0.5f, 0.25f, 1.0f);
    Scene scene = scene_of(floor_at(0.0f), matt(albedo));
    const Environment dark = uniform(0.0f);
    const auto floor_shows = [&](const Light& light, glm::vec3 point, double irradiance) {
        scene.lights = {light};
        expect_near(look(scene, dark, point, kDown, 4), glm::dvec3(albedo) * irradiance / glm::pi<double>(), 1e-4);
    };
    Light light;
    light.kind = Light::Kind::kDirectional;
    light.direction = glm::normalize(glm::vec3(std::sqrt(3.0f), -1, 0));
    light.intensity = glm::vec3(3.0f);
    floor_shows(light, glm::vec3(0.1f, 0, 0.1f), 3.0 * 0.5);

    light.kind = Light::Kind::kPoint;
    light.position = {0, 2, 0};
    floor_shows(light, glm::vec3(0, 0, 0), 3.0 / 4);
    floor_shows(light, glm::vec3(1.5f, 0, 0), 3.0 / 6.25 * (2 / 2.5));
    light.range = 4.0f;
    floor_shows(light, glm::vec3(0, 0, 0), 3.0 / 4 * (1 - 1.0 / 16));
    light.range = 1.9f;
    floor_shows(light, glm::vec3(0, 0, 0), 0.0);

    light.kind = Light::Kind::kSpot;
    light.range = std::numeric_limits<float>::infinity();
    light.direction = {0, -1, 0};
    light.inner_cone_angle = 0.2f;
    light.outer_cone_angle = 0.8f;
    floor_shows(light, glm::vec3(0.3f, 0, 0), 3.0 / 4.09 * (2 / std::sqrt(4.09)));
    const double cosine = std::cos(0.6), ramp = (cosine - std::cos(0.8)) / (std::cos(0.2) - std::cos(0.8));
    const double distance2 = 4.0 / (cosine * cosine);
    floor_shows(light, glm::vec3(2 * std::tan(0.6f), 0, 0), 3.0 / distance2 * cosine * ramp * ramp);
    floor_shows(light, glm::vec3(2 * std::tan(0.85f), 0, 0), 0.0);
}

/// Directions spread evenly over the sphere (Swinbank & Purser, "Fibonacci grids", 2006).
std::vector<glm::vec3> spread_directions(int count) {
    std::vector<glm::vec3> directions;
    for (int i = 0; i < count; ++i) {
        const double y = 1.0 - (2.0 * i + 1.0) / count, across = std::sqrt(1.0 - y * y);
        const double angle = glm::pi<double>() * (3.0 - std::sqrt(5.0)) * i;
        directions.emplace_back(across * std::cos(angle), y, across * std::sin(angle));
    }
    return directions;
}

TEST(PathTracer, RoughGlassIsInvisibleAmongSunsOnAllSides) {
    // The suns are a furnace of radiance 1. What they send through a rough boundary comes from outside of the glass.
    constexpr int kSuns = 150;
    Scene scene = load_scene("shape:slab");
    scene.materials[0].roughness = 0.7f;
    for (const glm::vec3& direction : spread_directions(kSuns)) {
        Light light;
        light.kind = Light::Kind::kDirectional;
        light.direction = direction;
        light.intensity = glm::vec3(4.0f * kPi / float(kSuns));
        scene.lights.push_back(light);
    }
    for (const glm::vec3 direction : {glm::vec3(0, 0, -1), glm::normalize(glm::vec3(1, 0.4f, -1))})
        expect_near(look(scene, uniform(0.0f), glm::vec3(0), direction, 1500), glm::dvec3(1.0), 0.01);
}

TEST(PathTracer, ALampInARoughBallSendsOutAllItsLight) {
    // By symmetry every direction sees the lamp's intensity, as the integral of radiance over the ball's disc.
    Scene scene = load_scene("shape:sphere,segments=64");
    scene.materials[0].roughness = 0.5f;
    scene.lights.resize(1);
    scene.lights[0].intensity = glm::vec3(3.0f);
    const float extent = 2.2f * scene_bounds(scene).half_size.x;
    const PathTracedImage image =
        path_trace(scene, parallel_camera(glm::vec3(0), {0, 0, -1}, extent), uniform(0.0f), 16, 1000);
    EXPECT_NEAR(mean(image.radiance) * double(extent * extent), 3.0, 0.03);
}

TEST(PathTracer, WhatStandsInALampsWay) {
    Light light;
    light.position = {0, 4, 0};
    light.intensity = glm::vec3(160.0f * kPi);  // shows as 1 on the floor, which throws little back
    const auto floor_below = [&](Mesh mesh, const Material& material, const glm::mat4& place = glm::mat4(1.0f)) {
        Scene scene = scene_of(floor_at(0.0f), matt(glm::vec3(0.1f)));
        scene.lights = {light};
        add(scene, std::move(mesh), material, place);
        // From the side, below what is in the way.
        const glm::vec3 direction = glm::normalize(glm::vec3(-1, -0.2f, 0));
        const PathTracedImage image =
            path_trace(scene, parallel_camera({0.01f, 0, 0.02f}, direction, 1e-4f, 1.0f), uniform(0.0f), 1, 4000);
        return image.radiance.at(0, 0)[0];
    };
    const glm::mat4 above = glm::translate(glm::mat4(1.0f), glm::vec3(0, 2, 0));
    const Material wall = matt(glm::vec3(0.0f));
    EXPECT_EQ(floor_below(floor_at(2.0f, 1.0f), wall), 0.0f);
    EXPECT_NEAR(floor_below(floor_at(2.0f, 1.0f), wall, glm::translate(glm::mat4(1.0f), glm::vec3(3, 0, 0))), 1.0f,
                1e-3f);
    Material pane = glass();
    pane.thickness = 0.0f;
    pane.base_color = glm::vec4(0.5f);
    pane.base_color.a = 1.0f;
    EXPECT_NEAR(floor_below(floor_at(2.0f, 1.0f), pane), 0.5f * (1 - 2 * 0.04f / 1.04f), 2e-3f)
        << "panes let it through";
    pane.transmission = 0.5f;
    EXPECT_NEAR(floor_below(floor_at(2.0f, 1.0f), pane), 0.25f * (1 - 2 * 0.04f / 1.04f), 3e-3f)
        << "their opaque part does not";
    EXPECT_EQ(floor_below(with_flat_normals(cube()), glass(), above), 0.0f) << "a stated limit of the method";
}

TEST(PathTracer, GlassOnAWhiteFloorIsInvisibleInTheFurnace) {
    // Light reaches the floor past the glass (chosen by the environment or by the floor) and through it (by
    // the floor alone): each once.
    Material pane = glass();
    pane.thickness = 0.0f;
    for (const bool solid : {true, false}) {
        Scene scene = load_scene("shape:sphere,segments=24");
        if (!solid) scene.materials[0] = pane;
        add(scene, floor_at(-1.0f, 8.0f), matt(glm::vec3(1.0f)));
        const PathTracedImage image = path_trace(
            scene, parallel_camera({0, -0.5f, 0}, glm::normalize(glm::vec3(0, -1, -1)), 4.0f), uniform(1.0f), 16, 256);
        EXPECT_NEAR(mean(image.radiance), 1.0, 4e-3);
        for (std::size_t i = 0; i < image.radiance.pixels.size(); ++i)
            EXPECT_NEAR(image.radiance.pixels[i], 1.0f, 5 * image.standard_error.pixels[i] + 2e-3f);
    }
}

TEST(PathTracer, HolesEmissionAndUnlit) {
    Scene scene = scene_of(floor_at(0.0f, 1.0f), matt(glm::vec3(0.5f, 1.0f, 0.25f)));
    Material& material = scene.materials[0];
    material.unlit = true;
    const Environment sky = uniform(7.0f);
    expect_near(look(scene, sky, {-0.5f, 0, 0}, kDown, 2), {0.5, 1, 0.25});
    expect_near(look(scene, sky, {-0.5f, 0, 0}, {0, 1, 0}, 2), {0.5, 1, 0.25}, 1e-5);

    Image mask(2, 1, 4);  // a hole on the left
    mask.pixels = {1, 1, 1, 0, 1, 1, 1, 1};
    scene.images = {mask};
    scene.image_names = {"mask"};
    material.base_color_texture.image = 0;
    material.base_color_texture.nearest = true;
    material.alpha_cutoff = 0.5f;
    expect_near(look(scene, sky, {-0.5f, 0, 0}, kDown, 2), {7, 7, 7});
    expect_near(look(scene, sky, {0.5f, 0, 0}, kDown, 2), {0.5, 1, 0.25});

    material.unlit = false;
    material.emission = {2, 3, 4};
    expect_near(look(scene, uniform(0.0f), {0.5f, 0, 0}, kDown, 2), {2, 3, 4});
    // What shines in glass shines out of it, less what the faces reflect back and forth. Radiance falls by n^2 on its way.
    Material shell = glass();
    Scene embedded = scene_of(floor_at(0.0f, 0.4f), matt(glm::vec3(0.0f)));
    embedded.materials[0].emission = {2, 3, 4};
    add(embedded, with_flat_normals(cube()), shell);
    expect_near(look(embedded, uniform(0.0f), {0.1f, 0, 0.1f}, kDown, 20000), 0.96 / 2.25 * glm::dvec3(2, 3, 4), 1e-3);
}

}  // namespace
}  // namespace pellucid
