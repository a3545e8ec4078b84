// Emissive surfaces in the path tracer: closed forms, and paths that aim at them beside paths that meet them by chance.
#include "core/math.h"
#include "path_pictures.h"
#include "reference/emitter_sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace pellucid {
namespace {

using namespace test;

constexpr double kPiExact = glm::pi<double>();

/// A black rectangle at height 1 above the floor that faces down and emits `radiance`.
Scene lit_floor(glm::vec2 low, glm::vec2 high, float radiance) {
    Scene scene = scene_of(floor_at(0.0f), matt(0.5f));
    Mesh panel;
    panel.positions = {{low.x, 1, low.y}, {high.x, 1, low.y}, {high.x, 1, high.y}, {low.x, 1, high.y}};
    panel.triangles = {{0, 1, 2}, {0, 2, 3}};
    panel.normals.assign(4, {0, -1, 0});
    panel.texcoords[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    Material emits = matt(0.0f);
    emits.emission = glm::vec3(radiance);
    emits.double_sided = false;
    add(scene, panel, emits);
    return scene;
}

/// Form factor from a surface element in the origin that faces up to a parallel rectangle at height 1, of which one corner is
/// above the element and the opposite one at (a, b): Howell, "A catalog of radiation heat transfer configuration factors", B-3.
double corner_factor(double a, double b) {
    const double ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
    return (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2 * kPiExact);
}
double form_factor(glm::dvec2 low, glm::dvec2 high) {
    return corner_factor(high.x, high.y) - corner_factor(low.x, high.y) - corner_factor(high.x, low.y) +
           corner_factor(low.x, low.y);
}

const glm::vec3 kAside = glm::normalize(glm::vec3(1, -0.2f, 0.1f));  // below the rectangle

TEST(EmissiveSurfaces, ARectangleLightsAFloorByItsFormFactor) {
    const glm::vec2 low(-0.3f, -0.5f), high(0.9f, 0.4f);
    const Scene scene = lit_floor(low, high, 4.0f);
    for (const glm::vec2 at : {glm::vec2(0.1f, 0.0f), glm::vec2(-1.5f, 2.0f), glm::vec2(3.0f, -1.0f)}) {
        SCOPED_TRACE(at.x);
        const Seen seen = look(scene, {at.x, 0, at.y}, kAside, 4000, 0.5f);
        const double expected =
            0.5 * 4 * form_factor(glm::dvec2(low) - glm::dvec2(at), glm::dvec2(high) - glm::dvec2(at));
        expect_seen(seen, expected);
        EXPECT_LT(seen.error, 0.01 * expected) << "a path that meets it by chance finds it too seldom for this";
    }
}

TEST(EmissiveSurfaces, TheRadianceIsThatOfTheTexture) {
    Scene scene = lit_floor({-1, -1}, {1, 1}, 4.0f);
    Image halves(2, 1, 3);  // the left half emits
    for (int c = 0; c < 3; ++c) halves.at(0, 0)[c] = 1.0f;
    scene.images = {halves};
    scene.image_names = {"halves"};
    Texture& texture = scene.materials[1].emission_texture;
    texture.image = 0;
    texture.nearest = true;
    texture.wrap_u = Wrap::kClamp;
    expect_seen(look(scene, {0.5f, 0, 0}, kAside, 20000, 0.5f), 0.5 * 4 * form_factor({-1.5, -1}, {-0.5, 1}));
}

TEST(EmissiveSurfaces, ASingleSidedOneDoesNotShineBackwards) {
    Scene scene = lit_floor({-1, -1}, {1, 1}, 4.0f);
    scene.objects[1].world_from_object =
        glm::translate(glm::mat4(1.0f), glm::vec3(0, 2, 0)) * glm::rotate(glm::mat4(1.0f), kPi, glm::vec3(1, 0, 0));
    EXPECT_EQ(look(scene, {0.1f, 0, 0.2f}, kAside, 200, 0.5f).radiance, 0.0);
    scene.materials[1].double_sided = true;
    expect_seen(look(scene, {0.1f, 0, 0.2f}, kAside, 20000, 0.5f), 0.5 * 4 * form_factor({-1.1, -1.2}, {0.9, 0.8}));
}

TEST(EmitterSampler, StatesTheDensityOfWhatItChooses) {
    Scene scene = lit_floor({-1, -1}, {1, 1}, 4.0f);
    scene.meshes[0] = floor_at(0.0f, 1.0f);
    scene.materials[0].emission = glm::vec3(1.0f);
    const reference::Geometry geometry(scene, {});
    const reference::EmitterSampler sampler(geometry, scene);
    ASSERT_FALSE(sampler.dark());
    const glm::dvec3 from(0.2, 0.5, 0.3);
    reference::Random random(1, 2, 3);
    constexpr int kCount = 100000;
    std::array<int, 2> chosen{};
    double solid_angle = 0.0;
    for (int i = 0; i < kCount; ++i) {
        const std::optional<reference::EmitterSampler::Sample> sample = sampler.sample(from, random);
        ASSERT_TRUE(sample);
        ++chosen[sample->object];
        if (sample->object == 1) solid_angle += 1.0 / sample->pdf / kCount;
        reference::Query ray;
        ray.origin = from;
        ray.direction = sample->direction;
        const reference::Hit hit = geometry.intersect(ray);
        ASSERT_TRUE(hit.found);
        ASSERT_NEAR(sampler.pdf(from, hit) / sample->pdf, 1.0, 1e-9);
    }
    EXPECT_NEAR(chosen[1], 0.8 * kCount, 5 * std::sqrt(0.16 * kCount)) << "four times as bright";
    // Solid angle of a rectangle at height 0.5, from its four corners.
    const auto corner = [](double a, double b) { return std::atan(a * b / std::sqrt(1 + a * a + b * b)); };
    const double expected = corner(1.6, 1.4) + corner(2.4, 1.4) + corner(1.6, 2.6) + corner(2.4, 2.6);
    EXPECT_NEAR(solid_angle, expected, 0.01 * expected);
}

/// A floor, rough metal, rough and clear glass with something inside, and a pane, below a panel that `material` lights.
Scene room(const Material& material) {
    const Mesh ball = load_scene("shape:sphere,segments=24").meshes[0];
    const auto at = [](glm::vec3 place, float size) {
        return glm::scale(glm::translate(glm::mat4(1.0f), place), glm::vec3(size));
    };
    Scene scene = scene_of(floor_at(-1.0f, 2.5f), matt({0.7f, 0.5f, 0.3f}));
    Material metal = matt({0.9f, 0.7f, 0.4f});
    metal.metallic = 1.0f;
    metal.roughness = 0.3f;
    add(scene, ball, metal, at({-1.2f, -0.6f, 0.5f}, 0.4f));
    Material rough = glass(1.3f);
    rough.roughness = 0.4f;
    rough.attenuation_color = {0.5f, 0.8f, 0.9f};
    rough.attenuation_distance = 0.5f;
    add(scene, ball, rough, at({1.1f, -0.4f, 0.4f}, 0.6f));
    add(scene, ball, matt(0.6f), at({1.1f, -0.4f, 0.4f}, 0.25f));
    add(scene, ball, glass(), at({0.0f, -0.4f, -0.4f}, 0.6f));
    Material pane = glass();
    pane.thickness = 0.0f;
    pane.base_color = {0.9f, 0.7f, 0.8f, 1.0f};
    add(scene, floor_at(0.4f, 0.8f), pane, glm::translate(glm::mat4(1.0f), glm::vec3(-0.8f, 0, 0)));
    add(scene, floor_at(0.0f, 0.8f), material,
        glm::translate(glm::mat4(1.0f), glm::vec3(0.2f, 1.2f, 0)) *
            glm::rotate(glm::mat4(1.0f), 0.3f, glm::vec3(0, 0, 1)));
    return scene;
}

/// Means of the parts of the light, and their errors, over pictures of `scene`.
struct Parts {
    std::array<double, 4> mean{}, error{};
};
Parts parts_of(const Scene& scene, const Camera& camera, std::uint32_t samples) {
    constexpr std::uint32_t kSeeds = 12;
    const Tracer tracer(scene);
    Parts parts;
    std::array<std::array<double, kSeeds>, 4> means{};
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        const PathTracedImage image = tracer.path_trace(
            camera, uniform(0.0f), {.width = 16, .height = 16, .samples = samples, .seed = seed, .parts = true});
        double sum = 0.0;
        for (std::size_t part = 0; part < 4; ++part) {
            for (const float value : image.parts[part].pixels) means[part][seed] += double(value) / (16 * 16 * 3);
            sum += means[part][seed];
        }
        EXPECT_NEAR(sum, mean_of(image).radiance, 1e-6 * sum) << "the parts are the picture";
    }
    for (std::size_t part = 0; part < 4; ++part) {
        for (const double mean : means[part]) parts.mean[part] += mean / kSeeds;
        for (const double mean : means[part])
            parts.error[part] += (mean - parts.mean[part]) * (mean - parts.mean[part]) / (kSeeds * (kSeeds - 1.0));
        parts.error[part] = std::sqrt(parts.error[part]);
    }
    return parts;
}

/// `emissive` against `unlit`, which shines as bright and which no path aims at.
void expect_alike(const Scene& emissive, const Scene& unlit, const Camera& camera, std::uint32_t samples) {
    const Parts aimed = parts_of(emissive, camera, samples / 4), by_chance = parts_of(unlit, camera, samples);
    for (std::size_t part = 0; part < 4; ++part) {
        SCOPED_TRACE(part);
        // Errors of 12 pictures follow Student's distribution: five of them are as seldom passed as four of the normal one.
        EXPECT_NEAR(aimed.mean[part], by_chance.mean[part], 5 * std::hypot(aimed.error[part], by_chance.error[part]));
        EXPECT_LE(by_chance.error[part], 0.04 * by_chance.mean[part]) << "else the test sees nothing";
    }
}

Material emits(float radiance) {
    Material material = matt(0.0f);
    material.emission = glm::vec3(radiance);
    material.double_sided = true;
    return material;
}
Material unlit() {
    Material material;
    material.unlit = true;
    material.double_sided = true;
    return material;
}

TEST(EmissiveSurfaces, AimingAtThemIsMeetingThemByChance) {
    const Camera camera = parallel_camera({0, -0.5f, 0}, glm::normalize(glm::vec3(-0.3f, -0.7f, -1)), 3.0f);
    expect_alike(room(emits(1.0f)), room(unlit()), camera, 2000);
}

TEST(EmissiveSurfaces, AnEmissivePaneShinesAsABlackOneDoes) {
    // Of air and clear, it hides nothing: what it emits adds to what is behind it, which is black here.
    Material pane = glass(1.0f);
    pane.thickness = 0.0f;
    pane.emission = glm::vec3(0.7f);
    const Camera camera = parallel_camera({0, -0.5f, 0}, glm::normalize(glm::vec3(-0.3f, -0.7f, -1)), 3.0f);
    const Parts of_pane = parts_of(room(pane), camera, 300), of_panel = parts_of(room(emits(0.7f)), camera, 300);
    EXPECT_NEAR(of_pane.mean[1], of_panel.mean[1], 5 * std::hypot(of_pane.error[1], of_panel.error[1]));
}

TEST(EmissiveSurfaces, InGlassTheirLightIsThatOfTheGlass) {
    // Unlit surfaces show as they are; emissive ones lose n^2 on their way out.
    const auto block = [](const Material& lamp) {
        Material tinted = glass();
        tinted.attenuation_color = {0.5f, 0.8f, 0.9f};
        tinted.attenuation_distance = 1.0f;
        Scene scene = scene_of(with_flat_normals(cube(1.6f)), tinted);
        const auto at = [](float y, float size) {
            return glm::scale(glm::translate(glm::mat4(1.0f), glm::vec3(0, y, 0)), glm::vec3(size));
        };
        const Mesh ball = load_scene("shape:sphere,segments=16").meshes[0];
        add(scene, ball, matt(0.6f), at(-0.3f, 0.35f));
        add(scene, ball, lamp, at(0.5f, 0.15f));
        return scene;
    };
    const Camera camera = parallel_camera({0, 0, 0}, glm::normalize(glm::vec3(-0.2f, -0.1f, -1)), 2.0f);
    expect_alike(block(emits(2.25f)), block(unlit()), camera, 1500);
}

}  // namespace
}  // namespace pellucid
