// Light in stills of more than 32 samples, which converge to the path tracer's picture; and what facets reflect of caustics.
#include "closed_form/lights.h"
#include "gpu/gpu_test.h"
#include "gpu/mean_color.h"
#include "unit/built_scenes.h"

#include <glm/gtc/matrix_transform.hpp>

#include <fmt/format.h>

#include <string>

namespace pellucid::test {
namespace {

Material facets(float roughness, float metallic) {
    Material material;
    material.base_color = glm::vec4(glm::vec3(metallic > 0.0f ? 0.8f : 0.0f), 1.0f);
    material.metallic = metallic;
    material.roughness = roughness;
    return material;
}

Mesh ball() { return load_scene("shape:sphere,segments=64").meshes[0]; }

glm::mat4 floor_at(float height) {
    const glm::mat4 upward = glm::rotate(glm::mat4(1.0f), -glm::radians(90.0f), {1, 0, 0});
    return glm::translate(glm::mat4(1.0f), {0, height, 0}) * glm::scale(upward, glm::vec3(3.0f));
}

/// Bright above and behind the eye, black elsewhere.
Environment half_bright() {
    Environment environment;
    environment.kind = Environment::Kind::kMap;
    environment.map = Image(64, 32, 3);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            const bool bright = y < 16 && x >= 32;  // of +Z
            for (int c = 0; c < 3; ++c) environment.map.at(x, y)[c] = bright ? 2.0f : 0.0f;
        }
    return environment;
}

class StillLight : public TechniqueTest {
protected:
    void set(const Scene& scene, const Environment& environment) {
        renderer().set_scene(scene);
        renderer().set_environment(environment);
        Camera camera;
        camera.world_from_view =
            glm::inverse(glm::lookAt(glm::vec3(0, 3, 5), glm::vec3(0, -0.3f, 0), glm::vec3(0, 1, 0)));
        camera.vertical_fov = 0.5f;
        renderer().set_camera(camera);
    }
    /// Mean radiance of a part of the picture.
    glm::dvec3 mean(const std::string& technique, std::uint32_t samples, const std::string& part,
                    ParameterMap parameters = {}) {
        RenderSettings settings;
        settings.width = settings.height = 32;
        settings.technique = technique;
        settings.samples = samples;
        settings.parameters = std::move(parameters);
        settings.aovs = {part};
        if (technique != "path") settings.light.transport = LightTransport::kFull;
        return mean_color(renderer().render(settings).aovs.at(part));
    }
    void expect_that_of_path(const std::string& part, std::uint32_t samples, std::uint32_t path_samples,
                             double tolerance, const ParameterMap& parameters = {}) {
        const glm::dvec3 found = mean(GetParam(), samples, part, parameters),
                         expected = mean("path", path_samples, part);
        EXPECT_GT(expected.g, 0.0);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], tolerance * expected[c]) << "channel " << c;
    }
};

// One look-up stands for the facets' lobe in frames, which is 10% off for a coat of roughness 1 here.
TEST_P(StillLight, WideFacetsReflectTheEnvironmentAsThePathTracerHasIt) {
    for (const float metallic : {0.0f, 1.0f}) {
        SCOPED_TRACE(metallic);
        set(scene_of(square(), facets(metallic > 0.0f ? 0.7f : 1.0f, metallic)), half_bright());
        expect_that_of_path("direct", 64, 512, 0.02);
    }
}

// Layers over a black base: coats with narrow and wide lobes, cloth, brushed metal. What rays bring of the environment is not
// counted a second time. The tolerance is that of one look-up for a narrow lobe (tests/gpu/test_finishes.cpp).
TEST_P(StillLight, LayersReflectTheEnvironmentOnce) {
    Material narrow = facets(1.0f, 0.0f), wide = narrow, cloth = narrow, brushed = facets(0.3f, 1.0f);
    narrow.finish.clearcoat = wide.finish.clearcoat = 1.0f;
    narrow.finish.clearcoat_roughness = 0.1f;
    wide.finish.clearcoat_roughness = 0.8f;
    cloth.finish.sheen_color = glm::vec3(0.9f);
    cloth.finish.sheen_roughness = 0.6f;
    brushed.finish.anisotropy = 0.9f;
    Mesh mesh = square();
    for (const glm::vec3 p : mesh.positions) mesh.texcoords[0].emplace_back(p.y, -p.x);  // brushed along y
    for (const Material& material : {narrow, wide, cloth, brushed}) {
        SCOPED_TRACE(fmt::format("coat {} of roughness {}, sheen {}, anisotropy {}", material.finish.clearcoat,
                                 material.finish.clearcoat_roughness, material.finish.sheen_color.r,
                                 material.finish.anisotropy));
        set(scene_of(mesh, material), half_bright());
        expect_that_of_path("direct", 40, 128, 0.13);
    }
}

// The floor is black under its coat.
TEST_P(StillLight, FacetsShowCaustics) {
    Scene scene = scene_of(ball());
    add(scene, square(), facets(0.6f, 0.0f), floor_at(-1.2f));
    scene.lights = {sun({0.2f, -1.0f, 0.3f}, 3.0f)};
    Environment dark;
    dark.kind = Environment::Kind::kUniform;
    dark.intensity = 0.0f;
    set(scene, dark);
    expect_that_of_path("caustic", 16, 64, 0.05, {{"photons", 65536.0}});
}

// Reflections that carry less than `threshold` branch off at random: none is left out. The tolerance is five times
// the noise of 64 samples. Without these branches half of the light is missing.
TEST_P(StillLight, WeakReflectionsAreThere) {
    set(scene_of(ball()), half_bright());
    expect_that_of_path("emitted", 64, 1024, 0.05, {{"threshold", 0.5}});
}

INSTANTIATE_TEST_SUITE_P(Techniques, StillLight, ::testing::Values("ray-tracing-cpu"), technique_test_name);

}  // namespace
}  // namespace pellucid::test
