// Normal textures, occlusion, coverage and the finishes of opaque surfaces, against the path tracer.
#include "gpu/gpu_test.h"

#include <array>

namespace pellucid::test {
namespace {

constexpr int kSize = 32;

Image one_texel(float r, float g, float b) {
    Image image(1, 1, 3);
    image.pixels = {r, g, b};
    return image;
}

class Finishes : public RendererTest {
protected:
    /// A ball, or another shape, of a material.
    void set(const Material& material, const Environment& environment, std::vector<Image> images = {},
             const char* shape = "shape:sphere") {
        Scene scene = load_scene(shape);
        scene.image_names.resize(images.size(), "texture");
        scene.images = std::move(images);
        scene.materials[0] = material;
        Mesh& mesh = scene.meshes[0];
        for (const glm::vec3& n : mesh.normals) mesh.texcoords[0].emplace_back(0.3f * n.x, -0.4f * n.y);
        show(scene, environment);
    }
    void show(const Scene& scene, const Environment& environment) {
        renderer().set_scene(scene);
        renderer().set_environment(environment);
        renderer().set_camera(framing_camera(scene_bounds(scene), kSize, kSize, Camera{}.vertical_fov));
    }
    Image draw(const char* technique, std::uint32_t samples) {
        RenderSettings settings;
        settings.width = settings.height = kSize;
        settings.technique = technique;
        settings.samples = samples;
        settings.light.transport = transport_;
        return renderer().render(settings).radiance;
    }
    static glm::vec3 mean_of(const Image& image) {
        glm::vec3 sum(0.0f);
        for (int y = kSize / 4; y < kSize - kSize / 4; ++y)
            for (int x = kSize / 4; x < kSize - kSize / 4; ++x) sum += rgb(image, x, y);
        return sum / float(kSize * kSize / 4);
    }
    /// Relative difference of the mean radiance of the picture's middle, largest over the channels.
    float difference(const char* technique = "wyman-2005", std::uint32_t paths = 256) {
        const glm::vec3 drawn = mean_of(draw(technique, 4)), truth = mean_of(draw("path", paths));
        const glm::vec3 off = glm::abs(drawn - truth) / truth;
        return std::max({off.r, off.g, off.b});
    }
    /// The same of two pictures, pixel by pixel.
    static float change(const Image& from, const Image& to) {
        Image apart = from;
        for (std::size_t i = 0; i < apart.pixels.size(); ++i) apart.pixels[i] = std::abs(to.pixels[i] - from.pixels[i]);
        const glm::vec3 off = mean_of(apart) / mean_of(from);
        return std::max({off.r, off.g, off.b});
    }
    LightTransport transport_ = LightTransport::kAutomatic;
};

Material dark_plastic() {
    Material material;
    material.base_color = {0.3f, 0.05f, 0.05f, 1.0f};
    material.roughness = 0.6f;
    return material;
}

Environment sky() {
    Environment environment;
    environment.kind = Environment::Kind::kSky;
    return environment;
}

// One filtered look-up stands for each lobe, and one angle for a film's facets: what that costs here is measured. A surface
// without its layers would be further off, as `least` says.
TEST_F(Finishes, LookAsThePathTracerHasThem) {
    struct Case {
        const char* name;
        Finish finish;
        float metallic, tolerance, least;
    };
    Finish coat, sheen, specular, film, brushed;
    coat.clearcoat = 1.0f;
    coat.clearcoat_roughness = 0.1f;
    sheen.sheen_color = {0.9f, 0.8f, 0.2f};
    sheen.sheen_roughness = 0.6f;
    specular.specular_color = {4.0f, 1.0f, 0.2f};
    film.iridescence = 1.0f;
    film.film_ior = 1.8f;
    film.film_thickest_nm = 500.0f;
    brushed.anisotropy = 0.8f;
    const std::array<Case, 5> cases = {{{"coat", coat, 0.0f, 0.05f, 0.1f},
                                        {"sheen", sheen, 0.0f, 0.08f, 0.2f},
                                        {"specular", specular, 0.0f, 0.04f, 0.08f},
                                        {"film", film, 1.0f, 0.08f, 0.2f},
                                        {"brushed", brushed, 1.0f, 0.13f, 0.15f}}};
    for (const Case& each : cases) {
        Material material = dark_plastic();
        material.metallic = each.metallic;
        set(material, sky());
        const Image plain = draw("wyman-2005", 4);
        material.finish = each.finish;
        set(material, sky());
        EXPECT_GE(change(plain, draw("wyman-2005", 4)), each.least) << each.name;
        EXPECT_LT(difference(), each.tolerance) << each.name;
    }
}

TEST_F(Finishes, AFlatNormalTextureChangesNothing) {
    Material material = dark_plastic();
    material.roughness = 0.1f;
    set(material, sky());
    const Image before = draw("wyman-2005", 1);
    material.normal_texture.image = 0;
    set(material, sky(), {one_texel(128.0f / 255.0f, 128.0f / 255.0f, 1.0f)});
    EXPECT_EQ(draw("wyman-2005", 1).pixels, before.pixels);
}

// By a technique that draws opaque triangles, and by one that follows paths. The tolerance is that of a filtered look-up.
TEST_F(Finishes, NormalTexturesTiltAsInThePathTracer) {
    Material material = dark_plastic();
    material.metallic = 1.0f;
    material.base_color = glm::vec4(1.0f);
    material.roughness = 0.3f;
    set(material, sky());
    const glm::vec3 plain = mean_of(draw("wyman-2005", 4));
    material.normal_texture.image = 0;
    const Image tilt = one_texel(150.0f / 255.0f, 175.0f / 255.0f, 1.0f);
    set(material, sky(), {tilt});
    const glm::vec3 tilted = mean_of(draw("wyman-2005", 4));
    EXPECT_GT(glm::distance(tilted, plain), 0.1f * glm::length(plain));
    EXPECT_LT(difference(), 0.08f);
    EXPECT_LT(difference("visibility-layers"), 0.08f);
}

TEST_F(Finishes, OcclusionWeakensTheEnvironmentUnlessRaysFindWhatHidesIt) {
    Material material = dark_plastic();
    set(material, sky());
    const glm::vec3 open = mean_of(draw("wyman-2005", 1)), truth = mean_of(draw("path", 16));
    material.occlusion_texture.image = 0;
    set(material, sky(), {one_texel(0.2f, 1.0f, 1.0f)});
    EXPECT_NEAR(mean_of(draw("wyman-2005", 1)).g / open.g, 0.2f, 1e-3f);
    EXPECT_EQ(mean_of(draw("path", 16)), truth);
    material.occlusion_strength = 0.5f;
    set(material, sky(), {one_texel(0.2f, 1.0f, 1.0f)});
    EXPECT_NEAR(mean_of(draw("wyman-2005", 1)).g / open.g, 0.6f, 1e-3f);
}

TEST_F(Finishes, CoverageIsTheMeanOverSamples) {
    Material material = dark_plastic();
    material.unlit = true;
    material.base_color = {0.0f, 0.0f, 0.0f, 0.25f};
    material.alpha_is_coverage = true;
    set(material, uniform_environment());
    // Half of what a ray crosses: the ball's front and its back.
    EXPECT_NEAR(mean_of(draw("wyman-2005", 64)).g, 0.75f * 0.75f, 0.02f);
    EXPECT_NEAR(mean_of(draw("path", 64)).g, 0.75f * 0.75f, 0.02f);
}

// The ball lets half of the sun through, twice. 64 samples of its coverage leave 2% noise.
TEST_F(Finishes, CoverageHoldsForShadowsToo) {
    Scene scene = load_scene("shape:sphere");
    Material cover = dark_plastic();
    cover.base_color = {0.0f, 0.0f, 0.0f, 0.5f};
    cover.ior = 1.0f;
    cover.alpha_is_coverage = true;
    Material ground;
    ground.roughness = ground.base_color.a = 1.0f;
    ground.ior = 1.0f;
    scene.materials = {cover, ground};
    Mesh floor;
    floor.positions = {{-4, -4, -1.5f}, {4, -4, -1.5f}, {4, 4, -1.5f}, {-4, 4, -1.5f}};
    floor.triangles = {{0, 1, 2}, {0, 2, 3}};
    floor.normals.assign(4, {0, 0, 1});
    scene.meshes.push_back(floor);
    scene.objects.push_back(Object{.name = "floor", .mesh = 1, .material = 1});
    Light sun;
    sun.kind = Light::Kind::kDirectional;
    sun.direction = glm::normalize(glm::vec3(-1.0f, -0.3f, -1.0f));
    sun.intensity = glm::vec3(3.0f);
    scene.lights = {sun};
    renderer().set_scene(scene);
    renderer().set_environment(uniform_environment(glm::vec3(0.01f)));
    renderer().set_camera(
        framing_camera(scene_bounds(load_scene("shape:sphere")), kSize, kSize, Camera{}.vertical_fov));
    transport_ = LightTransport::kDirect;
    const float drawn = mean_of(draw("visibility-layers", 64)).g, truth = mean_of(draw("path", 64)).g;
    EXPECT_NEAR(drawn / truth, 1.0f, 0.05f) << drawn << " " << truth;
}

}  // namespace
}  // namespace pellucid::test
