// Light of emissive surfaces and of the environment that glass bends and metal reflects, in frames: photons against closed
// forms and the path tracer.
#include "gpu/gpu_test.h"
#include "gpu/mean_color.h"
#include "unit/built_scenes.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <numbers>

namespace pellucid::test {
namespace {

using std::numbers::pi;

Material diffuse(float albedo, float emission = 0.0f) {
    Material material;
    material.base_color = glm::vec4(glm::vec3(albedo), 1.0f);
    material.roughness = 1.0f;
    material.ior = 1.0f;
    material.emission = glm::vec3(emission);
    return material;
}

Material polished_metal(float roughness) {
    Material metal = diffuse(0.9f);
    metal.metallic = 1.0f;
    metal.roughness = roughness;
    return metal;
}

/// Of radius 1 m, around the origin.
Mesh ball() {
    Scene scene = load_scene("shape:sphere,segments=128");
    const Bounds bounds = scene_bounds(scene);
    for (glm::vec3& p : scene.meshes[0].positions) p = (p - bounds.center) / bounds.half_size;
    return scene.meshes[0];
}

glm::mat4 placed(glm::vec3 at, float scale) {
    return glm::scale(glm::translate(glm::mat4(1.0f), at), glm::vec3(scale));
}
glm::mat4 upward(glm::vec3 at, float half_side) {
    return placed(at, half_side) * glm::rotate(glm::mat4(1.0f), -float(0.5 * pi), {1, 0, 0});
}

/// Black and all around.
void enclose(Scene& scene) {
    Scene cube = load_scene("shape:cube");
    const Bounds bounds = scene_bounds(cube);
    for (glm::vec3& p : cube.meshes[0].positions) p = 6.0f * (p - bounds.center) / bounds.half_size;
    add(scene, with_flat_normals(inside_out(cube.meshes[0])), diffuse(0.0f));
}

/// W/sr per unit of radiance, from both faces of a square (of 2 m, then placed) onto a ball on one side of its plane: the form
/// factor of a ball is cos R^2 / d^2 (Howell, "A catalog of radiation heat transfer configuration factors", B-33).
double flux_onto_ball(const glm::mat4& world_from_square, glm::dvec3 center, double radius) {
    constexpr int kSide = 64;
    const glm::dmat4 world(world_from_square);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(world[2])), x(world[0]), y(world[1]), origin(world[3]);
    const double area = 4.0 * glm::length(glm::cross(x, y)) / (kSide * kSide);
    double sum = 0.0;
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            const glm::dvec3 to_ball =
                center - (origin + ((2 * i + 1.0) / kSide - 1) * x + ((2 * j + 1.0) / kSide - 1) * y);
            const double d = glm::length(to_ball);
            sum += area * pi * std::abs(glm::dot(normal, to_ball)) / d * radius * radius / (d * d);
        }
    }
    return sum;
}

/// Dim blue, with a sun of 5.6 degrees in the direction of +X, 45 degrees up.
Environment sunny() {
    Environment environment;
    environment.kind = Environment::Kind::kMap;
    environment.map = Image(64, 32, 3);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 64; ++x) {
            const glm::vec3 radiance = (x == 31 || x == 32) && (y == 7 || y == 8) ? glm::vec3(50.0f, 45.0f, 40.0f)
                                                                                  : glm::vec3(0.05f, 0.1f, 0.2f);
            for (int c = 0; c < 3; ++c) environment.map.at(x, y)[c] = radiance[c];
        }
    }
    return environment;
}

/// W/m2, from all directions together.
glm::dvec3 integral(const Environment& environment) {
    constexpr int kRows = 1024;
    glm::dvec3 sum(0.0);
    for (int y = 0; y < kRows; ++y) {
        const double colatitude = (y + 0.5) / kRows * pi, share = pi / kRows * pi / kRows * std::sin(colatitude);
        for (int x = 0; x < 2 * kRows; ++x) {
            const double longitude = (x + 0.5) / kRows * pi;
            sum += share * glm::dvec3(radiance(
                               environment, glm::vec3(std::sin(colatitude) * std::cos(longitude), std::cos(colatitude),
                                                      std::sin(colatitude) * std::sin(longitude))));
        }
    }
    return sum;
}

Camera looking_down_on(glm::vec3 target, glm::vec3 from, float extent) {
    Camera camera;
    camera.world_from_view = glm::inverse(glm::lookAt(from, target, glm::vec3(0, 0, -1)));
    camera.orthographic = true;
    camera.vertical_extent = extent;
    return camera;
}

class PhotonSources : public TechniqueTest {
protected:
    RenderResult draw(const Scene& scene, const Environment& environment, std::uint32_t photons,
                      const Camera& camera = {}, std::uint32_t samples = 1, std::uint32_t size = 16) {
        renderer().set_scene(scene);
        renderer().set_environment(environment);
        renderer().set_camera(camera);
        RenderSettings settings;
        settings.width = settings.height = size;
        settings.technique = GetParam();
        settings.samples = samples;
        settings.light.transport = LightTransport::kFull;
        settings.parameters["photons"] = photons;
        settings.photon_flux = true;
        return renderer().render(settings);
    }
    PhotonFlux flux_of(const Scene& scene, const Environment& environment, std::uint32_t photons = 250000) {
        return draw(scene, environment, photons).photon_flux;
    }
    /// What draw() has drawn last, by the path tracer.
    RenderResult trace(std::uint32_t samples, std::uint32_t size = 16) {
        RenderSettings settings;
        settings.width = settings.height = size;
        settings.technique = "path";
        settings.samples = samples;
        settings.aovs = {"caustic"};
        return renderer().render(settings);
    }
};

glm::dvec3 arrived(const PhotonFlux& flux, bool bent) {
    glm::dvec3 sum(0.0);
    for (const PhotonFlux::Received& object : flux.objects) sum += bent ? object.bent : object.straight;
    return sum;
}

TEST_P(PhotonSources, ABlackBoxGetsWhatAnEmissiveSquareSendsOntoGlass) {
    // The balls' common sphere holds the square in the second scene: photons leave in all directions there.
    const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), 0.4f, {0, 1, 0});
    for (const bool within : {false, true}) {
        SCOPED_TRACE(within);
        Scene scene;
        add(scene, ball(), glass(), placed({-2, 0, 0}, 0.5f));
        if (within) add(scene, ball(), glass(), placed({2, 0.5f, 0}, 0.5f));
        const glm::mat4 square_at =
            glm::scale(turned * glm::rotate(glm::mat4(1.0f), float(0.5 * pi), {0, 1, 0}), glm::vec3(0.3f));
        add(scene, square(), diffuse(0.0f, 3.0f), square_at);
        enclose(scene);
        double expected = 3.0 * flux_onto_ball(square_at, {-2, 0, 0}, 0.5);
        if (within) expected += 3.0 * flux_onto_ball(square_at, {2, 0.5, 0}, 0.5);
        const PhotonFlux flux = flux_of(scene, uniform(0.0f));
        EXPECT_NEAR(arrived(flux, true).g, expected, 0.01 * expected);
        EXPECT_NEAR((arrived(flux, true) + arrived(flux, false) + flux.left).g, flux.sent.g, 0.002 * flux.sent.g);
        const double emitted = 2 * pi * 3.0 * 0.36;
        if (within) {
            EXPECT_NEAR(flux.sent.g, emitted, 0.01 * emitted);
        }
    }
}

TEST_P(PhotonSources, AnEnvironmentGoesThroughAClearBall) {
    Environment turned = sunny();
    turned.rotation = 1.3f;
    turned.intensity = 0.5f;
    Environment odd = turned;  // cells of the table are no whole texels
    odd.map = Image(301, 149, 3);
    for (std::size_t i = 0; i < odd.map.pixels.size(); ++i) odd.map.pixels[i] = i % 977 == 0 ? 200.0f : 0.1f;
    Environment sky;
    sky.kind = Environment::Kind::kSky;
    for (const Environment& environment : {uniform(2.0f), turned, odd, sky}) {
        SCOPED_TRACE(int(environment.kind));
        const PhotonFlux flux = flux_of(scene_of(ball(), glass()), environment);
        const glm::dvec3 expected = pi * integral(environment);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(flux.sent[c], expected[c], 0.01 * expected[c]) << c;
            EXPECT_NEAR(flux.left[c], flux.sent[c], 0.002 * flux.sent[c]) << c;
        }
    }
}

/// A ball, and a patch of floor on which it throws the light from 45 degrees above +X.
struct PatchScene {
    Scene scene;
    double area = 0.0;
    Camera camera = looking_down_on({-1.3f, -1.5f, 0}, {-5.3f, 3.0f, 0}, 2.4f);
};
PatchScene patch_below_ball(bool square_lamp) {
    PatchScene patch;
    add(patch.scene, ball(), glass(), placed({0, 0, 0}, 0.8f));
    const float half_side = 0.6f;
    add(patch.scene, square(), diffuse(0.5f), upward({-1.3f, -1.5f, 0}, half_side));
    if (square_lamp) {
        const glm::mat4 aimed = glm::inverse(glm::lookAt(glm::vec3(3, 3, 0), glm::vec3(0), glm::vec3(0, 0, 1)));
        add(patch.scene, square(), diffuse(0.0f, 30.0f), glm::scale(aimed, glm::vec3(0.25f)));
    }
    return patch;
}

// The flux onto the patch, before kernels, beside the path tracer's caustic. 3%: noise of the path tracer, which meets the small
// sources by chance.
TEST_P(PhotonSources, APatchGetsTheCausticOfThePathTracer) {
    for (const bool square_lamp : {false, true}) {
        SCOPED_TRACE(square_lamp ? "square lamp" : "sun of a map");
        const PatchScene patch = patch_below_ball(square_lamp);
        const Environment environment = square_lamp ? uniform(0.0f) : sunny();
        const glm::dvec3 found = draw(patch.scene, environment, 250000, patch.camera).photon_flux.objects[1].bent;
        const RenderResult traced = trace(16384);
        // Radiance of a pixel stands for its part of the floor, which it sees aslant.
        const glm::dvec3 way = glm::normalize(glm::dvec3(4.0, -4.5, 0.0));
        const double floor_in_view = 2.4 * 2.4 / -way.y;
        const glm::dvec3 truth = pi / 0.5 * floor_in_view * mean_color(traced.aovs.at("caustic"));
        EXPECT_GT(truth.g, 0.01);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], truth[c], 0.03 * truth[c]) << c;
    }
}

/// A glass ball and a rough metal mirror over a floor.
Scene floor_scene(bool square_lamp, float albedo) {
    Scene scene;
    add(scene, ball(), glass(), placed({0.5f, 0, 0}, 0.8f));
    add(scene, square(), diffuse(albedo), upward({0, -1.2f, 0}, 3.0f));
    add(scene, square(), polished_metal(square_lamp ? 0.0f : 0.2f),
        placed({-1.8f, 0, 0}, 0.8f) * glm::rotate(glm::mat4(1.0f), 1.1f, {0, 1, 0}) *
            glm::rotate(glm::mat4(1.0f), -0.4f, {1, 0, 0}));
    if (square_lamp) {
        const glm::mat4 aimed = glm::inverse(glm::lookAt(glm::vec3(2, 4, 1), glm::vec3(0), glm::vec3(0, 0, 1)));
        add(scene, square(), diffuse(0.0f, 30.0f), glm::scale(aimed, glm::vec3(0.3f)));
    }
    return scene;
}

// All light on a floor, seen past, in and through glass. Techniques blur the environment that diffuse reflections see, and kernels
// at the floor's edge cut off light: 1%. The lamp's caustic is 1% of what is seen, so counting it twice must show: 0.5%.
TEST_P(PhotonSources, AFloorIsAsBrightAsThePathTracerHasIt) {
    for (const bool square_lamp : {false, true}) {
        SCOPED_TRACE(square_lamp ? "square lamp" : "sun of a map");
        const Scene scene = floor_scene(square_lamp, 0.5f);
        const Environment environment = square_lamp ? uniform(0.0f) : sunny();
        const Camera camera = looking_down_on({0, -1.2f, 0}, {0, 8, 0}, 4.0f);
        const glm::dvec3 found = mean_color(draw(scene, environment, 65536, camera, 64, 64).radiance);
        const glm::dvec3 truth = mean_color(trace(1024, 64).radiance);
        const double tolerance = square_lamp ? 0.005 : 0.01;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], truth[c], tolerance * truth[c]) << c;
    }
}

// In an even environment rays of bounces find all that glass and metal throw, with noise. With photons, nothing counts twice.
// 0.5%: noise of the bounces.
TEST_P(PhotonSources, PhotonsOfAnEvenEnvironmentBringWhatBouncesFind) {
    const Scene scene = floor_scene(false, 0.5f);
    const Camera camera = looking_down_on({0, -1.2f, 0}, {0, 8, 0}, 4.0f);
    const double with = mean_color(draw(scene, uniform(1.0f), 65536, camera, 64, 64).radiance).g;
    const double without = mean_color(draw(scene, uniform(1.0f), 0, camera, 64, 64).radiance).g;
    EXPECT_NEAR(with, without, 0.005 * without);
}

INSTANTIATE_TEST_SUITE_P(Paths, PhotonSources, ::testing::Values("ray-tracing-cpu", "visibility-cube"),
                         technique_test_name);

}  // namespace
}  // namespace pellucid::test
