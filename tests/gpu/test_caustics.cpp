// Light that glass bends and metal reflects, in frames: photons against closed forms.
#include "closed_form/lights.h"
#include "gpu/gpu_test.h"
#include "unit/built_scenes.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <numbers>

namespace pellucid::test {
namespace {

using std::numbers::pi;

Material diffuse(float albedo) {
    Material material;
    material.base_color = glm::vec4(glm::vec3(albedo), 1.0f);
    material.roughness = 1.0f;
    material.ior = 1.0f;
    return material;
}

Mesh box(float half_side) {
    Scene cube = load_scene("shape:cube");
    const Bounds bounds = scene_bounds(cube);
    for (glm::vec3& p : cube.meshes[0].positions) p = half_side * (p - bounds.center) / bounds.half_size;
    return with_flat_normals(cube.meshes[0]);
}

/// Black, and seen from inside only.
void enclose(Scene& scene) {
    Material black = diffuse(0.0f);
    black.double_sided = false;
    add(scene, with_flat_normals(inside_out(box(6.0f))), black);
}

glm::mat4 upward_at(float y, float half_side) {
    const glm::mat4 turned = glm::rotate(glm::translate(glm::mat4(1.0f), {0, y, 0}), -float(0.5 * pi), {1, 0, 0});
    return glm::scale(turned, glm::vec3(half_side));
}

/// Flux, W, that a light sends onto a convex mesh: by the areas, or solid angles, of the triangles that face it (Van
/// Oosterom & Strackee, "The solid angle of a plane triangle", 1983).
double flux_onto(const Mesh& mesh, const Light& light) {
    double sum = 0.0;
    for (const glm::uvec3 t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]), from(light.position);
        const glm::dvec3 p = a - from, q = b - from, r = c - from;
        const double lp = glm::length(p), lq = glm::length(q), lr = glm::length(r);
        const double facing =
            light.kind == Light::Kind::kDirectional
                ? -0.5 * glm::dot(glm::cross(b - a, c - a), glm::dvec3(light.direction))
                : -2.0 * std::atan2(glm::dot(p, glm::cross(q, r)),
                                    lp * lq * lr + glm::dot(p, q) * lr + glm::dot(p, r) * lq + glm::dot(q, r) * lp);
        sum += std::max(facing, 0.0);
    }
    return sum * double(light.intensity.g);
}

class Caustics : public TechniqueTest {
protected:
    RenderResult draw(const Scene& scene, std::uint32_t photons, const Camera& camera = {}, std::uint32_t samples = 1,
                      std::uint32_t size = 16) {
        renderer().set_scene(scene);
        renderer().set_environment(uniform_environment(glm::vec3(0.0f)));
        renderer().set_camera(camera);
        RenderSettings settings;
        settings.width = settings.height = size;
        settings.technique = GetParam();
        settings.samples = samples;
        settings.parameters["photons"] = photons;
        settings.photon_flux = true;
        return renderer().render(settings);
    }
    PhotonFlux flux_of(const Scene& scene, std::uint32_t photons = 250000) { return draw(scene, photons).photon_flux; }
};

glm::dvec3 total(const PhotonFlux& flux) {
    glm::dvec3 sum = flux.left;
    for (const PhotonFlux::Received& object : flux.objects) sum += object.bent + object.straight;
    return sum;
}

TEST_P(Caustics, ABlackBoxGetsWhatMeetsClearGlass) {
    for (const Light& light : {sun({0.3f, -1.0f, 0.2f}, 1.0f), lamp({1.2f, 2.0f, -0.7f}, 3.0f)}) {
        Scene scene = scene_of(with_flat_normals(load_scene("shape:sphere,segments=24").meshes[0]), glass());
        enclose(scene);
        scene.lights = {light};
        const PhotonFlux flux = flux_of(scene);
        ASSERT_EQ(flux.objects.size(), 2u);
        const double expected = flux_onto(scene.meshes[0], light);
        EXPECT_NEAR(flux.objects[1].bent.g, expected, 0.01 * expected);
        EXPECT_NEAR(total(flux).g, flux.sent.g, 0.002 * flux.sent.g);
    }
}

/// Of light on a ball that absorbs e^-`depth` along a diameter, the share that leaves: every ring reflects r, and the rest
/// goes to and fro along chords.
double share_that_leaves(double ior, double depth) {
    constexpr int kRings = 20000;
    double sum = 0.0;
    for (int i = 0; i < kRings; ++i) {
        const double sin2 = (i + 0.5) / kRings, cos_i = std::sqrt(1.0 - sin2),
                     cos_t = std::sqrt(1.0 - sin2 / ior / ior);
        const double s = (cos_i - ior * cos_t) / (cos_i + ior * cos_t),
                     p = (ior * cos_i - cos_t) / (ior * cos_i + cos_t);
        const double r = 0.5 * (s * s + p * p), a = std::exp(-depth * cos_t);
        sum += r + (1 - r) * (1 - r) * a / (1 - r * a);
    }
    return sum / kRings;
}

TEST_P(Caustics, ABlackBoxGetsWhatAnAbsorbingBallLeaves) {
    // Interpolated normals: photons take the weight of Veach 1997, 5.3.
    Scene ball = load_scene("shape:sphere,segments=128");
    ball.lights = {sun({0.3f, -1.0f, 0.2f}, 1.0f)};
    const double entered = flux_onto(ball.meshes[0], ball.lights[0]);
    ball.materials[0].attenuation_color = {1.0f, 0.5f, 0.1f};
    ball.materials[0].attenuation_distance = 2.0f * scene_bounds(ball).half_size.x;
    enclose(ball);
    const glm::dvec3 flux = flux_of(ball).objects[1].bent;
    const std::array<double, 3> depths{0.0, std::log(2.0), std::log(10.0)};
    for (int c = 0; c < 3; ++c) {
        const double expected = entered * share_that_leaves(double(ball.materials[0].ior), depths[std::size_t(c)]);
        EXPECT_NEAR(flux[c], expected, 0.01 * expected) << "channel " << c;
    }
}

TEST_P(Caustics, APlateSharesOutASunAsItsSeriesSays) {
    for (const float ior : {1.5f, 2.4f}) {
        SCOPED_TRACE(testing::Message() << "index " << ior);
        Scene scene = scene_of(box(0.5f), glass(ior));
        scene.materials[0].base_color = {1.0f, 0.5f, 0.25f, 1.0f};
        Material black = diffuse(0.0f);
        black.double_sided = false;  // so that the sun shines through from behind
        add(scene, square(), black, upward_at(-2.0f, 3.0f));
        add(scene, square(), black, glm::rotate(upward_at(-2.0f, 3.0f), float(pi), {1, 0, 0}));
        scene.objects[2].world_from_object[3].y = 2.0f;
        scene.lights = {sun({0, -1, 0}, 1.0f)};
        const PhotonFlux flux = flux_of(scene);
        const double n = double(ior), through = 2 * n / (n * n + 1), r = std::pow((n - 1) / (n + 1), 2);
        const glm::dvec3 base(1.0, 0.5, 0.25), down = base * through, up = r + base * (1 - through - r);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(flux.objects[1].bent[c], down[c], 0.01 * down[c]) << "tinted once, where it leaves";
            EXPECT_NEAR(flux.objects[2].bent[c], up[c], 0.03 * up[c]) << "reflected outside and in";
        }
    }
}

TEST_P(Caustics, ALampInGlassSendsAllOfItsLightOut) {
    // From the middle of a ball every ray leaves along the normal: 4% go back, and leave elsewhere.
    Scene scene = scene_of(load_scene("shape:sphere,segments=128").meshes[0], glass());
    enclose(scene);
    scene.lights = {lamp({0.01f, 0.02f, -0.01f}, 3.0f)};
    const PhotonFlux flux = flux_of(scene);
    EXPECT_NEAR(flux.objects[1].bent.g, 4 * pi * 3.0, 0.01 * 4 * pi * 3.0);
    EXPECT_EQ(flux.objects[1].straight.g, 0.0);
}

TEST_P(Caustics, MetalSendsASunOnAsAMirrorDoes) {
    // A mirror of 1 m x 1 m at 45 degrees throws light of E cos(45) on a wall; Schlick's share at 45 degrees.
    Scene scene;
    Material metal = diffuse(0.8f);
    metal.metallic = 1.0f;
    metal.roughness = 0.0f;
    add(scene, square(), metal,
        glm::scale(glm::rotate(glm::mat4(1.0f), -float(0.25 * pi), {1, 0, 0}), glm::vec3(0.5f)));
    add(scene, square(), diffuse(0.5f), glm::translate(glm::mat4(1.0f), {0, 0, 2}));
    scene.lights = {sun({0, -1, 0}, 2.0f)};
    const PhotonFlux flux = flux_of(scene);
    const double share = 0.8 + 0.2 * std::pow(1 - std::sqrt(0.5), 5), expected = 2.0 * std::sqrt(0.5) * share;
    EXPECT_NEAR(flux.objects[1].bent.g, expected, 0.01 * expected);
    EXPECT_EQ(flux.objects[0].bent.g, 0.0);
}

// Rough metal throws light on a wall that gets no other. In full light a path from the wall can meet the metal's highlight of the
// sun, too: photons alone have it. The path tracer has no photons there. 2%: its noise, and kernels of the photons.
TEST_P(Caustics, RoughMetalThrowsItsLightOnce) {
    Scene scene;
    Material metal = diffuse(0.8f);
    metal.metallic = 1.0f;
    metal.roughness = 0.25f;
    add(scene, square(), metal, glm::rotate(glm::mat4(1.0f), -float(0.25 * pi), {1, 0, 0}));
    add(scene, square(), diffuse(0.5f), glm::scale(glm::translate(glm::mat4(1.0f), {0, 0, 3}), glm::vec3(2.0f)));
    scene.lights = {sun({0, -1, 0}, 2.0f)};
    Camera camera;
    camera.world_from_view = glm::rotate(glm::translate(glm::mat4(1.0f), {0, 0, 2}), float(pi), {0, 1, 0});
    camera.vertical_fov = 0.4f;
    const auto mean = [](const Image& image) {
        double sum = 0.0;
        for (const float value : image.pixels) sum += double(value);
        return sum / double(image.pixels.size());
    };
    const double found = mean(draw(scene, 100000, camera, 16).radiance);
    RenderSettings settings;
    settings.width = settings.height = 16;
    settings.technique = "path";
    settings.samples = 8192;
    const double truth = mean(renderer().render(settings).radiance);
    EXPECT_GT(truth, 0.1);
    EXPECT_NEAR(found, truth, 0.02 * truth);
}

TEST_P(Caustics, AFloorShowsTheCausticOfABallLens) {
    Scene scene = load_scene("shape:sphere,segments=128");
    const Bounds bounds = scene_bounds(scene);
    const double radius = double(bounds.half_size.x);
    scene.lights = {sun({0, -1, 0}, 1.0f)};
    add(scene, square(), diffuse(0.1f), upward_at(float(double(bounds.center.y) - 1.6 * radius), 4.0f));
    const auto rings = rings_below_ball(double(scene.materials[0].ior), 1.6, 0.01, 60);
    for (const std::size_t ring : {15u, 30u, 45u}) {
        const double rho = (double(ring) + 0.5) * 0.01;
        double flux = 0.0;
        for (const std::size_t i : {ring - 1, ring, ring + 1}) flux += rings[i];
        const double expected = 0.1 / pi * flux / (pi * 6 * rho * 0.01);
        const glm::vec3 target = bounds.center + float(radius) * glm::vec3(0.0f, -1.6f, float(rho)), way(-1, -0.5f, 0);
        Camera camera;
        camera.world_from_view =
            glm::inverse(glm::lookAt(target - 3.0f * float(radius) * glm::normalize(way), target, {0, 1, 0}));
        camera.orthographic = true;
        camera.vertical_extent = 0.02f * float(radius);
        const RenderResult drawn = draw(scene, 65536, camera, 16, 8);
        double mean = 0.0;
        for (const float value : drawn.radiance.pixels) mean += double(value) / double(drawn.radiance.pixels.size());
        EXPECT_NEAR(mean, expected, 0.04 * expected) << "at " << rho << " radii";
    }
}

TEST_P(Caustics, TwoRunsAreBitEqual) {
    Scene scene = load_scene("shape:sphere");
    const Bounds bounds = scene_bounds(scene);
    add(scene, square(), diffuse(0.8f), upward_at(bounds.center.y - bounds.half_size.y, 4.0f));
    scene.lights = {sun({0.4f, -1.0f, 0.2f}, 1.0f), lamp({1.0f, 3.0f, 1.0f}, 3.0f)};
    const Camera camera = orbit_camera(bounds, 20.0f, 50.0f, 12.0f, 0.5f);
    const Image first = draw(scene, 40000, camera, 2, 64).radiance, second = draw(scene, 40000, camera, 2, 64).radiance;
    const Image without = draw(scene, 0, camera, 2, 64).radiance;
    EXPECT_EQ(first.pixels, second.pixels);
    double light = 0.0, dark = 0.0;
    for (const float value : first.pixels) light += double(value);
    for (const float value : without.pixels) dark += double(value);
    EXPECT_GT(light, 1.02 * dark) << "there is a caustic";
}

/// Techniques, run from the light's view.
class CausticsByTechnique : public Caustics {};

TEST_P(CausticsByTechnique, APlatePassesASunTwiceRefracted) {
    Scene scene = scene_of(box(0.5f), glass());
    scene.materials[0].base_color = {1.0f, 0.5f, 0.25f, 1.0f};
    add(scene, square(), diffuse(0.5f), upward_at(-2.0f, 3.0f));
    scene.lights = {sun({0, -1, 0}, 1.0f)};
    renderer().set_scene(scene);
    renderer().set_environment(uniform_environment(glm::vec3(0.0f)));
    RenderSettings settings;
    settings.width = settings.height = 16;
    settings.technique = "visibility-cube";
    settings.parameters["photons"] = 100000;
    settings.photon_flux = true;
    settings.light.caustics = GetParam();
    const PhotonFlux flux = renderer().render(settings).photon_flux;
    const double passes = std::pow(1.0 - 0.04, 2);  // what is reflected inside is left out
    for (int c = 0; c < 3; ++c) {
        const double expected = passes * double(scene.materials[0].base_color[c]);
        EXPECT_NEAR(flux.objects[1].bent[c], expected, 0.02 * expected);
    }
}

INSTANTIATE_TEST_SUITE_P(Techniques, CausticsByTechnique,
                         ::testing::Values("wyman-2005", "oliveira-brauwers-2007", "wang-2014"), technique_test_name);

INSTANTIATE_TEST_SUITE_P(Paths, Caustics, ::testing::Values("ray-tracing-cpu", "visibility-cube"), technique_test_name);

}  // namespace
}  // namespace pellucid::test
