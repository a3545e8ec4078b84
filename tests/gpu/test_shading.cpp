// Opaque and thin-walled surfaces, textures, tone mapping.
#include "gpu/gpu_test.h"

namespace pellucid::test {
namespace {

/// Square in the plane z = `z` of half side `half`, facing +Z, with texture coordinates (v downwards).
Mesh square(float z, float half) {
    Mesh mesh;
    for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
        mesh.positions.emplace_back(half * corner.x, half * corner.y, z);
        mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
        mesh.texcoords[0].emplace_back(0.5f + 0.5f * corner.x, 0.5f - 0.5f * corner.y);
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// Without a coat, which an index of 1 does not have.
Material painted(glm::vec3 color, bool unlit = false) {
    Material material;
    material.base_color = glm::vec4(color, 1.0f);
    material.ior = 1.0f;
    material.unlit = unlit;
    return material;
}

void add(Scene& scene, Mesh mesh, Material material) {
    Object object;
    object.mesh = int(scene.meshes.size());
    object.material = int(scene.materials.size());
    scene.meshes.push_back(std::move(mesh));
    scene.materials.push_back(std::move(material));
    scene.objects.push_back(object);
}

/// From +Z; the unit square fills the picture.
Camera front_camera() {
    Camera camera;
    camera.orthographic = true;
    camera.vertical_extent = 2.0f;
    camera.world_from_view = glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, 5));
    return camera;
}

class Shading : public RendererTest {
protected:
    RenderResult render(const Scene& scene, const RenderSettings& settings) {
        renderer().set_scene(scene);
        renderer().set_camera(front_camera());
        renderer().set_environment(uniform_environment());
        return renderer().render(settings);
    }
    RenderResult render(const Scene& scene) {
        RenderSettings settings;
        settings.width = settings.height = 16;
        return render(scene, settings);
    }
};

void expect_color(const Image& image, int x, int y, glm::vec3 expected, float tolerance = 2e-3f) {
    EXPECT_LT(glm::distance(rgb(image, x, y), expected), tolerance)
        << x << "," << y << ": " << rgb(image, x, y).r << " " << rgb(image, x, y).g << " " << rgb(image, x, y).b;
}

// A diffuse surface under uniform radiance 1 gets irradiance pi and shows its albedo.
TEST_F(Shading, DiffuseSurfaceShowsItsAlbedo) {
    for (const bool unlit : {false, true}) {
        Scene scene;
        add(scene, square(0.0f, 0.5f), painted({0.2f, 0.5f, 0.7f}, unlit));
        const RenderResult result = render(scene);
        expect_color(result.radiance, 8, 8, {0.2f, 0.5f, 0.7f});
        expect_color(result.radiance, 1, 1, {1.0f, 1.0f, 1.0f});  // the environment beside it
        EXPECT_EQ(result.covered, 0u);
    }
}

TEST_F(Shading, EmissionIsAdded) {
    Scene scene;
    Material lamp = painted({0.0f, 0.0f, 0.0f});
    lamp.emission = {3.0f, 2.0f, 1.0f};
    add(scene, square(0.0f, 1.0f), lamp);
    expect_color(render(scene).radiance, 8, 8, {3.0f, 2.0f, 1.0f});
}

TEST_F(Shading, NearestOpaqueSurfaceWins) {
    Scene scene;
    add(scene, square(0.5f, 0.5f), painted({1, 0, 0}, true));
    add(scene, square(-0.5f, 1.0f), painted({0, 1, 0}, true));
    const RenderResult result = render(scene);
    expect_color(result.radiance, 8, 8, {1, 0, 0});
    expect_color(result.radiance, 1, 8, {0, 1, 0});
}

TEST_F(Shading, TexturesAreDecodedPlacedAndWrapped) {
    const glm::vec3 grey(0.21586f);  // 128 / 255, what 8 bits make of 0.5, in linear light
    Scene scene;
    Image image(2, 2, 3);  // sRGB-encoded; first row on top
    const glm::vec3 texels[4] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5f, 0.5f, 0.5f}};
    for (int i = 0; i < 4; ++i) std::copy_n(&texels[i].x, 3, image.at(i % 2, i / 2));
    scene.images.push_back(image);
    scene.image_names.push_back("corners");
    Material material = painted({1, 1, 1}, true);
    material.base_color_texture.image = 0;
    material.base_color_texture.nearest = true;
    add(scene, square(0.0f, 1.0f), material);
    const RenderResult plain = render(scene);
    expect_color(plain.radiance, 3, 3, {1, 0, 0});
    expect_color(plain.radiance, 12, 3, {0, 1, 0});
    expect_color(plain.radiance, 3, 12, {0, 0, 1});
    expect_color(plain.radiance, 12, 12, grey);

    // Twice as many repetitions: every quarter holds the whole picture.
    scene.materials[0].base_color_texture.uv_from_texcoord[0][0] = 2.0f;
    scene.materials[0].base_color_texture.uv_from_texcoord[1][1] = 2.0f;
    expect_color(render(scene).radiance, 9, 9, {1, 0, 0});
    expect_color(render(scene).radiance, 13, 9, {0, 1, 0});
    scene.materials[0].base_color_texture.wrap_u = Wrap::kMirror;
    expect_color(render(scene).radiance, 9, 9, {0, 1, 0});
    scene.materials[0].base_color_texture.wrap_u = Wrap::kClamp;
    scene.materials[0].base_color_texture.wrap_v = Wrap::kClamp;
    expect_color(render(scene).radiance, 15, 15, grey);
    expect_color(render(scene).radiance, 15, 1, {0, 1, 0});
}

TEST_F(Shading, AlphaCutOutShowsWhatIsBehind) {
    Scene scene;
    Material leaf = painted({1, 0, 0}, true);
    leaf.base_color.a = 0.4f;
    leaf.alpha_cutoff = 0.5f;
    add(scene, square(0.5f, 1.0f), leaf);
    add(scene, square(0.0f, 1.0f), painted({0, 0, 1}, true));
    expect_color(render(scene).radiance, 8, 8, {0, 0, 1});
}

Material glass(float thickness) {
    Material material;
    material.transmission = 1.0f;
    material.thickness = thickness;
    return material;
}

TEST_F(Shading, OpaqueSurfacesHideGlassAndGlassHidesThem) {
    Scene scene = load_scene("shape:sphere");
    add(scene, square(2.0f, 0.2f), painted({1, 0, 0}, true));   // in front of the ball
    add(scene, square(-2.0f, 1.0f), painted({0, 1, 0}, true));  // behind it
    const RenderResult result = render(scene);
    expect_color(result.radiance, 8, 8, {1, 0, 0});
    expect_color(result.radiance, 0, 0, {0, 1, 0});
    const glm::vec3 through_glass = rgb(result.radiance, 8, 4);  // the square behind, and a reflection
    EXPECT_GT(through_glass.g, 0.8f);
    EXPECT_GT(through_glass.r, 0.02f);
    EXPECT_LT(through_glass.r, 0.3f);
    EXPECT_GT(result.covered, 100u);
}

// Both are rasterised from the same triangles; their depths must not differ by rounding.
TEST_F(Shading, OpaqueSurfaceInTheSamePlaceHidesGlass) {
    Scene scene = load_scene("shape:torus");
    scene.materials.push_back(painted({1, 0, 0}, true));
    scene.objects.push_back(scene.objects[0]);
    scene.objects[1].material = 1;
    EXPECT_EQ(render(scene).covered, 0u);
}

// 2 R / (1 + R) of normal incidence is reflected, the rest goes straight on with the pane's colour.
TEST_F(Shading, ThinWalledPaneTintsAndReflects) {
    Scene scene;
    Material pane = glass(0.0f);
    pane.base_color = {0.5f, 0.8f, 1.0f, 1.0f};
    add(scene, square(0.5f, 1.0f), pane);
    add(scene, square(0.0f, 1.0f), painted({0.6f, 0.6f, 0.0f}, true));
    const RenderResult result = render(scene);
    const float reflectance = 2.0f * 0.04f / 1.04f;
    expect_color(result.radiance, 8, 8, (1.0f - reflectance) * glm::vec3(0.3f, 0.48f, 0.0f) + reflectance);
    EXPECT_EQ(result.covered, 0u);  // thin walls do not bend light
}

TEST_F(Shading, PartialTransmissionMixesWithTheDiffuseSurface) {
    Scene scene = load_scene("shape:sphere");
    scene.materials[0].transmission = 0.25f;
    scene.materials[0].base_color = {0.0f, 1.0f, 0.0f, 1.0f};
    RenderSettings settings;
    settings.width = settings.height = 16;
    settings.technique = "one-interface";
    // Uniform radiance 1: whatever the split, green keeps everything and red only the reflection.
    const RenderResult result = render(scene, settings);
    expect_color(result.radiance, 8, 8, {0.04f, 1.0f, 0.04f}, 5e-3f);
}

TEST_F(Shading, ToneMappingNoneIsClippingAndTheSrgbCurve) {
    Scene scene;
    add(scene, square(0.0f, 1.0f), painted({0.2140411f, 0.0021f, 1.0f}, true));
    scene.materials[0].base_color.b = 4.0f;
    RenderSettings settings;
    settings.width = settings.height = 4;
    settings.tonemap = ToneMap::kNone;
    const RenderResult result = render(scene, settings);
    EXPECT_NEAR(rgb(result.display, 2, 2).r, 0.5f, 0.51f / 255.0f);
    EXPECT_NEAR(rgb(result.display, 2, 2).g, 12.92f * 0.0021f, 0.51f / 255.0f);
    EXPECT_EQ(rgb(result.display, 2, 2).b, 1.0f);
    settings.exposure_ev = -2.0f;
    EXPECT_NEAR(rgb(render(scene, settings).radiance, 2, 2).b, 4.0f, 1e-5f);  // exposure is for display only
    EXPECT_NEAR(rgb(render(scene, settings).display, 2, 2).b, 1.0f, 0.5f / 255.0f);
    for (const ToneMap curve : {ToneMap::kReinhard, ToneMap::kAces, ToneMap::kNeutral}) {
        settings.tonemap = curve;
        const glm::vec3 shown = rgb(render(scene, settings).display, 2, 2);
        EXPECT_GT(shown.b, shown.r);
        EXPECT_GT(shown.r, shown.g);
    }
}

}  // namespace
}  // namespace pellucid::test
