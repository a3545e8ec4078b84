// What textures of directions and extensions of glTF make of opaque surfaces, on the path tracer and alone.
#include "gltf_builder.h"
#include "path_pictures.h"

#include "reference/finished_bsdf.h"
#include "reference/sheen.h"
#include "reference/thin_film.h"
#include "scene/mesh_tangents.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid::test {
namespace {

using namespace reference;

glm::dvec3 direction_at(double cos_theta) { return {std::sqrt(1.0 - cos_theta * cos_theta), 0.0, cos_theta}; }

/// What a surface reflects of even light, by sampling.
double sampled_albedo(const FinishedPoint& point, double cos_o) {
    const FinishedBsdf bsdf(point);
    constexpr int kSamples = 20000;
    double sum = 0.0;
    Random random(1, 2, 3);
    for (int i = 0; i < kSamples; ++i)
        if (const auto sample = bsdf.sample(direction_at(cos_o), random)) sum += sample->weight.g / kSamples;
    return sum;
}

/// The same by integrating evaluate() over directions spread evenly.
double albedo(const FinishedPoint& point, double cos_o) {
    const FinishedBsdf bsdf(point);
    constexpr int kSteps = 100;
    double sum = 0.0;
    Random random(1, 2, 3);
    for (int i = 0; i < kSteps; ++i) {
        const double z = (i + 0.5) / kSteps, r = std::sqrt(1.0 - z * z);
        for (int j = 0; j < 2 * kSteps; ++j) {
            const double angle = std::numbers::pi * (j + 0.5) / kSteps;
            const glm::dvec3 wi(r * std::cos(angle), r * std::sin(angle), z);
            sum += bsdf.evaluate(direction_at(cos_o), wi, random).value.g * std::numbers::pi / (kSteps * kSteps);
        }
    }
    return sum;
}

FinishedPoint white(double roughness = 0.5) { return {.base = glm::dvec3(1.0), .roughness = roughness}; }

TEST(Finishes, SamplesAndDensitiesAgree) {
    FinishedPoint coated = white(), cloth = white(), brushed = white(0.3), film = white(), tilted = white(),
                  rough_coat = white();
    coated.coat = 1.0;
    coated.coat_roughness = 0.4;
    cloth.sheen = glm::dvec3(0.8);
    cloth.sheen_roughness = 0.5;
    brushed.metallic = 1.0;
    brushed.anisotropy = 0.7;
    brushed.along = glm::normalize(glm::dvec2(1.0, 2.0));
    film.film = 1.0;
    tilted.coat = 1.0;
    tilted.coat_roughness = 0.5;
    tilted.coat_normal = glm::normalize(glm::dvec3(0.2, 0.1, 1.0));
    rough_coat.base = glm::dvec3(0.0);
    rough_coat.coat = rough_coat.coat_roughness = 1.0;
    rough_coat.coat_normal = glm::normalize(glm::dvec3(0.6, 0.0, 1.0));
    int number = 0;
    for (const FinishedPoint& point : {coated, cloth, brushed, film, tilted, rough_coat}) {
        for (const double cos_o : {0.3, 0.9})
            EXPECT_NEAR(sampled_albedo(point, cos_o), albedo(point, cos_o), 0.015)
                << "surface " << number << ", cosine " << cos_o;
        ++number;
    }
}

// White under a smooth coat gives back all light, since the coat takes what it reflects from the rest. No
// finish makes light.
TEST(Finishes, FurnaceOfEveryLayer) {
    FinishedPoint plain = white(1.0);
    plain.ior = 1.0;
    EXPECT_NEAR(sampled_albedo(plain, 0.6), 1.0, 1e-6);
    FinishedPoint coated = plain;
    coated.coat = 1.0;
    for (const double cos_o : {0.1, 0.5, 1.0}) EXPECT_NEAR(sampled_albedo(coated, cos_o), 1.0, 0.01) << cos_o;
    for (const double roughness : {0.3, 1.0}) {
        for (const double cos_o : {0.02, 0.5}) {
            FinishedPoint point = white(roughness);
            point.coat = 1.0;
            point.coat_roughness = 0.5;
            EXPECT_LT(albedo(point, cos_o), 1.02) << "coat " << roughness << " " << cos_o;
            point.coat = 0.0;
            point.sheen = glm::dvec3(1.0);
            for (const double fibres : {0.2, 1.0}) {
                point.sheen_roughness = fibres;
                EXPECT_LT(albedo(point, cos_o), 1.03) << "sheen " << fibres << " " << cos_o;
            }
        }
    }
}

TEST(Finishes, SheenTableIsTheIntegralOfTheBrdf) {
    for (const double roughness : {0.4, 1.0}) {
        FinishedPoint cloth{.base = glm::dvec3(0.0), .ior = 1.0};
        cloth.sheen = glm::dvec3(1.0);
        cloth.sheen_roughness = roughness;
        EXPECT_NEAR(albedo(cloth, 0.6), sheen_albedo(0.6, roughness), 0.01) << roughness;
    }
}

TEST(Finishes, SpecularScalesAndColoursWhatDielectricsReflect) {
    FinishedPoint black{.base = glm::dvec3(0.0), .roughness = 0.3};
    const double usual = albedo(black, 0.9);
    black.specular = 0.5;
    EXPECT_NEAR(albedo(black, 0.9), 0.5 * usual, 1e-3 * usual);
    black.specular = 1.0;
    black.specular_color = glm::dvec3(1.0, 0.0, 1.0);
    EXPECT_LT(albedo(black, 0.9), 0.01 * usual) << "green, head-on";
    black.specular = 0.0;
    EXPECT_EQ(albedo(black, 0.9), 0.0);
}

// Without a film, and under a thick one of the index of what is below, known reflectances.
TEST(Finishes, FilmHasItsLimits) {
    const glm::dvec3 at_normal(0.04, 0.3, 0.9);
    for (const double cos_theta : {0.3, 0.8, 1.0}) {
        const double weight = std::pow(1.0 - cos_theta, 5.0);
        const glm::dvec3 schlick = at_normal + (1.0 - at_normal) * weight;
        const glm::dvec3 none = film_reflectance(cos_theta, 1.5, 0.0, at_normal);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(none[k], schlick[k], 1e-12) << cos_theta << " " << k;
    }
    const glm::dvec3 thick = film_reflectance(1.0, 1.5, 50000.0, glm::dvec3(0.04));
    const glm::dvec3 thin = film_reflectance(1.0, 1.5, 400.0, glm::dvec3(0.3));
    EXPECT_NEAR(thick.r, 0.04, 1e-3) << "of one index with what is below it";
    EXPECT_GT(std::abs(thin.r - thin.b), 0.05) << "colours";
}

Image one_texel(float r, float g, float b, float a = 1.0f) {
    Image image(1, 1, 4);
    image.pixels = {r, g, b, a};
    return image;
}

/// A floor of rough metal, seen aslant under a sky with a bright half.
Scene metal_floor() {
    Scene scene;
    scene.meshes = {floor_at(0.0f)};
    Material material;
    material.metallic = 1.0f;
    material.roughness = 0.4f;
    material.base_color = {0.9f, 0.8f, 0.7f, 1.0f};
    scene.materials = {material};
    scene.objects = {Object{.name = "floor"}};
    return scene;
}

Image picture_of(const Scene& scene, std::uint32_t samples = 4) {
    return Tracer(scene)
        .path_trace(parallel_camera({0, 0, 0}, glm::normalize(glm::vec3(0.4f, -1.0f, -0.7f)), 0.5f), two_sides(),
                    {.width = 8, .height = 8, .samples = samples})
        .radiance;
}

void add_texture(Scene& scene, Texture& texture, const Image& image) {
    texture.image = int(scene.images.size());
    scene.images.push_back(image);
    scene.image_names.emplace_back("texture");
}

TEST(NormalTextures, AFlatOneChangesNothing) {
    Scene scene = metal_floor();
    const Image before = picture_of(scene);
    add_texture(scene, scene.materials[0].normal_texture, one_texel(128.0f / 255.0f, 128.0f / 255.0f, 1.0f));
    EXPECT_EQ(picture_of(scene).pixels, before.pixels);
}

TEST(NormalTextures, AConstantTiltIsThatOfTiltedNormals) {
    Scene textured = metal_floor(), tilted = metal_floor();
    const float x = 200.0f, y = 100.0f;
    add_texture(textured, textured.materials[0].normal_texture, one_texel(x / 255.0f, y / 255.0f, 1.0f));
    // u runs along +x, v along +z: green leads to -z.
    const glm::vec3 normal = glm::normalize(glm::vec3((x - 128.0f) / 127.0f, 1.0f, -(y - 128.0f) / 127.0f));
    tilted.meshes[0].normals.assign(4, normal);
    const Image a = picture_of(textured), b = picture_of(tilted), flat = picture_of(metal_floor());
    double difference = 0.0, from_flat = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        difference += std::abs(double(a.pixels[i]) - double(b.pixels[i]));
        from_flat += std::abs(double(a.pixels[i]) - double(flat.pixels[i]));
        sum += double(b.pixels[i]);
    }
    EXPECT_LT(difference, 1e-4 * sum);
    EXPECT_GT(from_flat, 0.1 * sum);
    // With tangents of the mesh that point elsewhere, these count; w turns green around.
    textured.meshes[0].tangents.assign(4, glm::vec4(0.0f, 0.0f, 1.0f, -1.0f));
    const glm::vec3 turned = glm::normalize(glm::vec3(-(y - 128.0f) / 127.0f, 1.0f, (x - 128.0f) / 127.0f));
    tilted.meshes[0].normals.assign(4, turned);
    const Image c = picture_of(textured), d = picture_of(tilted);
    difference = 0.0;
    for (std::size_t i = 0; i < c.pixels.size(); ++i) difference += std::abs(double(c.pixels[i]) - double(d.pixels[i]));
    EXPECT_LT(difference, 1e-4 * sum);
}

TEST(NormalTextures, MadeTangentsFollowTextureCoordinates) {
    Mesh mesh = floor_at(0.0f);
    for (const glm::vec4& tangent : make_tangents(mesh, 0)) EXPECT_EQ(tangent, glm::vec4(1, 0, 0, 1));
    for (glm::vec2& uv : mesh.texcoords[0]) uv.x = -uv.x;
    for (const glm::vec4& tangent : make_tangents(mesh, 0)) EXPECT_EQ(tangent, glm::vec4(-1, 0, 0, -1));
    // Halves that mirror each other: what they share has no tangent.
    mesh.texcoords[0] = {{0, 1}, {1, 1}, {0, 1}, {1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    EXPECT_EQ(make_tangents(floor_at(0.0f), 1).size(), 0u) << "no second set";
}

json with_texture(const char* name) { return {{name, {{"index", 0}, {"scale", 0.5}}}}; }

TEST(Finishes, AreReadFromGltf) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    const int normals = b.attribute<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 3);
    const int texcoords = b.attribute<float>({0, 1, 1, 1, 0, 0}, kFloat, "VEC2", 2);
    json& primitive = b.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["NORMAL"] = normals;
    primitive["attributes"]["TEXCOORD_0"] = texcoords;
    primitive["material"] = 0;
    b.root["images"] = {{{"uri",
                          "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk"
                          "+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="}}};
    b.root["textures"] = {{{"source", 0}}};
    json material = with_texture("normalTexture");
    material["occlusionTexture"] = {{"index", 0}, {"strength", 0.25}};
    material["extensions"] = {
        {"KHR_materials_clearcoat",
         {{"clearcoatFactor", 0.5},
          {"clearcoatRoughnessFactor", 0.2},
          {"clearcoatNormalTexture", {{"index", 0}, {"scale", 2}}}}},
        {"KHR_materials_sheen", {{"sheenColorFactor", {0.1, 0.2, 0.3}}, {"sheenRoughnessFactor", 0.4}}},
        {"KHR_materials_specular", {{"specularFactor", 0.6}, {"specularColorFactor", {2, 1, 0}}}},
        {"KHR_materials_iridescence", {{"iridescenceFactor", 0.7}, {"iridescenceThicknessMaximum", 500}}},
        {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.8}, {"anisotropyRotation", 1.5}}}};
    b.root["materials"] = {material};
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_TRUE(scene.warnings.empty());
    const Material& read = scene.materials.at(0);
    EXPECT_EQ(read.normal_texture.image, 0);
    EXPECT_EQ(read.normal_scale, 0.5f);
    EXPECT_EQ(read.occlusion_texture.image, 0);
    EXPECT_EQ(read.occlusion_strength, 0.25f);
    const Finish& f = read.finish;
    EXPECT_EQ(f.clearcoat, 0.5f);
    EXPECT_EQ(f.clearcoat_roughness, 0.2f);
    EXPECT_EQ(f.clearcoat_normal_scale, 2.0f);
    EXPECT_EQ(f.sheen_color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(f.sheen_roughness, 0.4f);
    EXPECT_EQ(f.specular, 0.6f);
    EXPECT_EQ(f.specular_color, glm::vec3(2, 1, 0));
    EXPECT_EQ(f.iridescence, 0.7f);
    EXPECT_EQ(f.film_thickest_nm, 500.0f);
    EXPECT_EQ(f.anisotropy, 0.8f);
    EXPECT_EQ(f.anisotropy_rotation, 1.5f);
    EXPECT_EQ(scene.meshes.at(0).tangents, std::vector<glm::vec4>(3, glm::vec4(1, 0, 0, 1))) << "made";
    const int tangents = b.attribute<float>({0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1}, kFloat, "VEC4", 4);
    b.root["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = tangents;
    EXPECT_EQ(load_scene(b.gltf(folder)).meshes.at(0).tangents, std::vector<glm::vec4>(3, glm::vec4(0, 1, 0, 1)));
    b.root["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
    EXPECT_EQ(load_scene(b.gltf(folder)).warnings.size(), 1u) << "tangents of the file alone do not say which texel";
    b.root["materials"][0].erase("normalTexture");
    b.root["materials"][0].erase("extensions");
    EXPECT_TRUE(load_scene(b.gltf(folder)).meshes.at(0).tangents.empty()) << "nothing needs them";
}

TEST(Coverage, IsTheShareOfRaysThatMeetTheSurface) {
    Scene scene;
    scene.meshes = {floor_at(1.0f), floor_at(0.0f)};
    Material cover, ground;
    cover.unlit = ground.unlit = true;
    cover.base_color = {1, 0, 0, 0.3f};
    cover.alpha_is_coverage = true;
    ground.base_color = {0, 0, 1, 1};
    scene.materials = {cover, ground};
    scene.objects = {Object{.name = "cover", .mesh = 0, .material = 0},
                     Object{.name = "ground", .mesh = 1, .material = 1}};
    const PathTracedImage seen = trace_picture(scene, parallel_camera({0, 0, 0}, {0, -1, 0}, 0.5f), 0.0f, 16, 64);
    double red = 0.0, blue = 0.0;
    for (std::size_t i = 0; i < seen.radiance.pixels.size(); i += 3) {
        red += double(seen.radiance.pixels[i]) / 256.0;
        blue += double(seen.radiance.pixels[i + 2]) / 256.0;
    }
    EXPECT_NEAR(red, 0.3, 0.02);
    EXPECT_NEAR(blue, 0.7, 0.02);
    // Light that comes down through it is weakened likewise.
    scene.materials[1] = matt(1.0f);
    scene.materials[0] = matt(0.0f);
    scene.materials[0].base_color.a = 0.3f;
    scene.materials[0].alpha_is_coverage = true;
    const Seen under = look(scene, {0, 0.5f, 0}, {0, -1, 0}, 1, 0.1f);
    EXPECT_EQ(under.radiance, 0.0) << "no sky";
    const Seen lit = mean_of(trace_picture(scene, parallel_camera({0, 0, 0}, {0, -1, 0}, 0.5f, 0.5f), 1.0f, 8, 256));
    EXPECT_NEAR(lit.radiance, 0.7, 0.02);
}

}  // namespace
}  // namespace pellucid::test
