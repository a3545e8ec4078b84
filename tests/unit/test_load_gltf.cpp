#include "core/math.h"
#include "gltf_builder.h"
#include "test_files.h"
#include "test_meshes.h"

#include <pellucid/image.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace pellucid {
namespace {

using namespace test;

Material material_of(json material, std::vector<std::string>* warnings = nullptr) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    material["name"] = "stuff";
    b.root["materials"] = {material};
    b.root["meshes"][0]["primitives"][0]["material"] = 0;
    const Scene scene = load_scene(b.gltf(folder));
    if (warnings) *warnings = scene.warnings;
    return scene.materials.at(0);
}

json extension(const char* name, json properties) { return {{"extensions", {{name, properties}}}}; }

/// The triangle's primitive with the given accessors.
Scene load_primitive(const std::function<void(GltfBuilder&, json& primitive)>& change) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    json primitive = b.root["meshes"][0]["primitives"][0];
    change(b, primitive);
    b.root["meshes"][0]["primitives"][0] = primitive;
    return load_scene(b.gltf(folder));
}

TEST(LoadGltf, TriangleFromTextAndFromBinary) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    for (const std::string& file : {b.gltf(folder), b.glb(folder)}) {
        const Scene scene = load_scene(file);
        EXPECT_EQ(broken_promise(scene), "");
        EXPECT_TRUE(scene.warnings.empty());
        ASSERT_EQ(scene.meshes.size(), 1u);
        EXPECT_EQ(scene.meshes[0].name, "thing");
        EXPECT_EQ(scene.meshes[0].positions[1], glm::vec3(1, 0, 0));
        EXPECT_EQ(scene.meshes[0].normals[1], glm::vec3(0, 0, 1)) << "made from the winding";
        EXPECT_EQ(scene.objects[0].name, "thing");
        const Material& material = scene.materials.at(0);
        EXPECT_FALSE(material.transmissive());
        EXPECT_EQ(material.metallic, 1.0f);
        EXPECT_EQ(material.roughness, 1.0f);
    }
}

TEST(LoadGltf, BufferAsDataUriAndWithEscapedName) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    const std::string file = b.gltf(folder);
    folder.file("my data.bin", b.bin);
    b.root["buffers"][0]["uri"] = "my%20data.bin";
    EXPECT_EQ(load_error(folder.file("b.gltf", b.root.dump())), "");
    b.root["buffers"][0]["uri"] =
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    EXPECT_EQ(load_error(folder.file("c.gltf", b.root.dump())), "");
    b.root["buffers"][0]["uri"] = "data:nonsense,AAAA";
    EXPECT_NE(load_error(folder.file("d.gltf", b.root.dump())), "");
}

TEST(LoadGltf, IndicesOfEverySizeStripsAndFans) {
    const std::vector<float> square = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const auto load = [&](int mode, auto indices, int type) {
        return load_primitive([&](GltfBuilder& b, json& primitive) {
            primitive["attributes"]["POSITION"] = b.attribute(square, kFloat, "VEC3", 3);
            primitive["indices"] = b.attribute(indices, type, "SCALAR", 1);
            primitive["mode"] = mode;
        });
    };
    const Scene scenes[] = {load(4, std::vector<std::uint8_t>{0, 1, 2, 2, 1, 3}, kUnsignedByte),
                            load(4, std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, kUnsignedShort),
                            load(4, std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3}, kUnsignedInt),
                            load(5, std::vector<std::uint16_t>{0, 1, 2, 3}, kUnsignedShort),
                            load(6, std::vector<std::uint16_t>{0, 1, 3, 2}, kUnsignedShort)};
    for (const Scene& scene : scenes) {
        EXPECT_EQ(scene.triangle_count(), 2u);
        for (const glm::uvec3 t : scene.meshes[0].triangles)
            EXPECT_EQ(face_normal(scene.meshes[0], t), glm::vec3(0, 0, 1)) << "strips and fans keep their winding";
    }
}

TEST(LoadGltf, PointsAndLinesAreLeftOutAndCounted) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    for (const int mode : {0, 1, 2, 3}) {
        json primitive = b.root["meshes"][0]["primitives"][0];
        primitive["mode"] = mode;
        b.root["meshes"][0]["primitives"].push_back(primitive);
    }
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_EQ(scene.triangle_count(), 1u);
    EXPECT_EQ(scene.meshes[0].name, "thing primitive 0");
    EXPECT_EQ(warnings_with(scene, "4 primitives of points or lines left out"), 1u);
}

TEST(LoadGltf, InterleavedSparseAndNormalizedAttributes) {
    const Scene interleaved = load_primitive([](GltfBuilder& b, json& primitive) {
        const int view = b.view<float>({0, 0, 0, 9, 0, 0, 1, 1, 0, 0, 9, 0, 0, 1, 0, 1, 0, 9, 0, 0, 1}, 28);
        primitive["attributes"]["POSITION"] = b.accessor(view, kFloat, "VEC3", 3);
        primitive["attributes"]["NORMAL"] = b.accessor(view, kFloat, "VEC3", 3, {{"byteOffset", 16}});
    });
    EXPECT_EQ(interleaved.meshes[0].positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(interleaved.meshes[0].normals[2], glm::vec3(0, 0, 1));

    const Scene sparse = load_primitive([](GltfBuilder& b, json& primitive) {
        const int which = b.view<std::uint16_t>({1, 2});
        const int values = b.view<float>({2, 0, 0, 0, 3, 0});
        primitive["attributes"]["POSITION"] =
            b.accessor(-1, kFloat, "VEC3", 3,
                       {{"sparse",
                         {{"count", 2},
                          {"indices", {{"bufferView", which}, {"componentType", kUnsignedShort}}},
                          {"values", {{"bufferView", values}}}}}});
    });
    EXPECT_EQ(sparse.meshes[0].positions, (std::vector<glm::vec3>{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}));

    const Scene quantized = load_primitive([](GltfBuilder& b, json& primitive) {
        b.root["extensionsRequired"] = b.root["extensionsUsed"] = {"KHR_mesh_quantization"};
        const int position = b.view<std::int16_t>({0, 0, 0, 0, 300, 0, 0, 0, 0, -200, 0, 0}, 8);
        primitive["attributes"]["POSITION"] = b.accessor(position, kShort, "VEC3", 3);
        const int normal = b.view<std::int8_t>({0, 0, 127, 0, 0, -128, 0, 0, 127, 0, 0, 0}, 4);
        primitive["attributes"]["NORMAL"] = b.accessor(normal, kByte, "VEC3", 3, {{"normalized", true}});
        const int texcoord = b.view<std::uint16_t>({0, 65535, 65535, 0, 0, 0});
        primitive["attributes"]["TEXCOORD_0"] = b.accessor(texcoord, kUnsignedShort, "VEC2", 3, {{"normalized", true}});
        const int color = b.view<std::uint8_t>({255, 0, 51, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 4);
        primitive["attributes"]["COLOR_0"] = b.accessor(color, kUnsignedByte, "VEC3", 3, {{"normalized", true}});
    });
    EXPECT_TRUE(quantized.warnings.empty());
    EXPECT_EQ(quantized.meshes[0].positions[1], glm::vec3(300, 0, 0));
    EXPECT_EQ(quantized.meshes[0].positions[2], glm::vec3(0, -200, 0));
    EXPECT_EQ(quantized.meshes[0].normals[1], glm::vec3(0, -1, 0)) << "-128 is -1 too";
    EXPECT_EQ(quantized.meshes[0].texcoords[0][0], glm::vec2(0, 1));
    EXPECT_EQ(quantized.meshes[0].colors[0], glm::vec4(1, 0, 0.2f, 1));
}

TEST(LoadGltf, BadNormalsAndShortAttributesGiveWarnings) {
    const Scene scene = load_primitive([](GltfBuilder& b, json& primitive) {
        primitive["attributes"]["NORMAL"] = b.attribute<float>({0, 0, 0, NAN, 0, 0, 0, 0, 2}, kFloat, "VEC3", 3);
        primitive["attributes"]["TEXCOORD_0"] = b.attribute<float>({0, 0, 1, 1}, kFloat, "VEC2", 2);
        primitive["attributes"]["TEXCOORD_1"] = b.attribute<float>({0, 0, 1, 1, INFINITY, 0}, kFloat, "VEC2", 2);
    });
    EXPECT_EQ(broken_promise(scene), "");
    EXPECT_EQ(warnings_with(scene, "2 normals were zero or not finite"), 1u);
    EXPECT_EQ(warnings_with(scene, "TEXCOORD_0 left out"), 1u);
    EXPECT_EQ(warnings_with(scene, "TEXCOORD_1 left out"), 1u);
    for (const glm::vec3 n : scene.meshes[0].normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
}

TEST(LoadGltf, TransformsMultiplyDownTheTree) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    b.root["nodes"] = json::array();
    const double h = std::sqrt(0.5);
    b.node({{"translation", {1, 2, 3}}, {"rotation", {0, 0, h, h}}, {"scale", {2, 2, -2}}, {"children", {1, 2}}});
    b.node({{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}}, {"mesh", 0}, {"name", "moved"}});
    b.node({{"mesh", 0}, {"name", "second"}});
    const Scene scene = load_scene(b.gltf(folder));
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(scene.meshes.size(), 1u) << "placed twice, read once";
    EXPECT_EQ(scene.objects[0].name, "moved");
    const glm::vec3 p = scene.objects[0].world_from_object * glm::vec4(1, 0, 1, 1);
    EXPECT_LT(glm::length(p - glm::vec3(1, 14, 1)), 1e-5f) << p.x << " " << p.y << " " << p.z;
    EXPECT_LT(glm::determinant(glm::mat3(scene.objects[0].world_from_object)), 0.0f) << "mirrors stay mirrors";
}

TEST(LoadGltf, TransformsThatCannotBe) {
    const auto error_with = [](json node) {
        const TemporaryFolder folder;
        GltfBuilder b = GltfBuilder::triangle();
        node["mesh"] = 0;
        node["name"] = "odd";
        b.root["nodes"][0] = node;
        return load_error(b.gltf(folder));
    };
    EXPECT_NE(error_with({{"matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}).find("odd: matrix"),
              std::string::npos);
    EXPECT_NE(error_with({{"matrix", {1, 2, 3}}}).find("odd: matrix"), std::string::npos);
    EXPECT_NE(error_with({{"translation", {1e300, 0, 0}}}).find("odd: transform"), std::string::npos);
    EXPECT_NE(error_with({{"rotation", {0, 0, 0, 0}}}).find("odd: rotation"), std::string::npos);
    EXPECT_NE(error_with({{"scale", {1, 0, 1}}}).find("contains no triangles"), std::string::npos);
}

TEST(LoadGltf, ObjectsScaledToNothingAreLeftOut) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    b.root["scenes"][0]["nodes"] = {0, 1};
    b.node({{"mesh", 0}, {"scale", {1, 0, 1}}, {"name", "flattened"}});
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(warnings_with(scene, "flattened: scaled to nothing"), 1u);
}

TEST(LoadGltf, ScenesAndRoots) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    b.node({{"mesh", 0}, {"name", "other"}});
    b.root["scenes"].push_back({{"nodes", {1}}});
    b.root["scene"] = 1;
    EXPECT_EQ(load_scene(b.gltf(folder)).objects.at(0).name, "other");
    b.root.erase("scene");
    EXPECT_EQ(load_scene(b.gltf(folder)).objects.at(0).name, "thing");
    b.root.erase("scenes");
    b.root["nodes"][0]["children"] = {1};
    EXPECT_EQ(load_scene(b.gltf(folder)).objects.size(), 2u) << "all nodes that are nobody's child, and below";
    b.root["scene"] = 7;
    b.root["scenes"] = {{{"nodes", {0}}}};
    EXPECT_NE(load_error(b.gltf(folder)).find("no scene 7"), std::string::npos);
}

TEST(LoadGltf, DeepTreesLoadAndCyclesAreErrors) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    constexpr int kDepth = 100000;
    b.root["nodes"] = json::array();
    for (int i = 0; i + 1 < kDepth; ++i) b.node({{"children", {i + 1}}});
    b.node({{"mesh", 0}});
    EXPECT_EQ(load_scene(b.gltf(folder)).objects.size(), 1u);
    b.root["nodes"].back()["children"] = {kDepth / 2};
    EXPECT_NE(load_error(b.gltf(folder)).find("own ancestor"), std::string::npos);
    b.root["nodes"].back()["children"] = {kDepth + 5};
    EXPECT_NE(load_error(b.gltf(folder)).find("no node"), std::string::npos);
}

TEST(LoadGltf, Cameras) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    b.root["cameras"] = {
        {{"name", "eye"}, {"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}, {"zfar", 50}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0}, {"zfar", 9}}}},
        {{"name", "blind"}, {"type", "perspective"}, {"perspective", {{"yfov", 4.0}, {"znear", 0.1}}}}};
    b.root["scenes"][0]["nodes"] = {0, 1, 2, 3};
    b.node({{"camera", 0}, {"translation", {0, 0, 5}}, {"scale", {3, -3, 3}}});
    b.node({{"camera", 1}, {"name", "flat"}});
    b.node({{"camera", 2}});
    const Scene scene = load_scene(b.gltf(folder));
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].name, "eye");
    EXPECT_EQ(scene.cameras[0].vertical_fov, 0.7f);
    EXPECT_EQ(scene.cameras[0].near_plane, 0.1f);
    EXPECT_EQ(scene.cameras[0].far_plane, 50.0f);
    EXPECT_EQ(glm::vec3(scene.cameras[0].world_from_view[3]), glm::vec3(0, 0, 5));
    EXPECT_NEAR(glm::determinant(glm::mat3(scene.cameras[0].world_from_view)), 1.0f, 1e-6f)
        << "scale is no part of a camera";
    EXPECT_EQ(scene.cameras[1].name, "flat");
    EXPECT_TRUE(scene.cameras[1].orthographic);
    EXPECT_EQ(scene.cameras[1].vertical_extent, 6.0f);
    EXPECT_EQ(warnings_with(scene, "camera blind"), 1u);
}

TEST(LoadGltf, GlassMaterial) {
    json m = {{"pbrMetallicRoughness",
               {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0}, {"roughnessFactor", 0.25}}},
              {"emissiveFactor", {0.5, 0, 0}},
              {"doubleSided", true},
              {"alphaMode", "MASK"},
              {"alphaCutoff", 0.3}};
    m["extensions"] = {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}}},
                       {"KHR_materials_volume",
                        {{"thicknessFactor", 2.5}, {"attenuationDistance", 3}, {"attenuationColor", {0.5, 0.6, 0.7}}}},
                       {"KHR_materials_ior", {{"ior", 1.7}}},
                       {"KHR_materials_dispersion", {{"dispersion", 0.4}}},
                       {"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}};
    std::vector<std::string> warnings;
    const Material material = material_of(m, &warnings);
    EXPECT_EQ(material.name, "stuff");
    EXPECT_EQ(material.base_color, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(material.metallic, 0.0f);
    EXPECT_EQ(material.roughness, 0.25f);
    EXPECT_EQ(material.emission, glm::vec3(4, 0, 0));
    EXPECT_TRUE(material.double_sided);
    EXPECT_FALSE(material.unlit);
    EXPECT_EQ(material.alpha_cutoff, 0.3f);
    EXPECT_EQ(material.transmission, 0.9f);
    EXPECT_EQ(material.thickness, 2.5f);
    EXPECT_EQ(material.attenuation_distance, 3.0f);
    EXPECT_EQ(material.attenuation_color, glm::vec3(0.5f, 0.6f, 0.7f));
    EXPECT_EQ(material.ior, 1.7f);
    EXPECT_EQ(material.dispersion, 0.4f);
    ASSERT_EQ(warnings.size(), 1u) << "only that a triangle is not closed";
    EXPECT_TRUE(material_of(extension("KHR_materials_unlit", json::object())).unlit);
    const Material thin = material_of(extension("KHR_materials_transmission", {{"transmissionFactor", 1}}));
    EXPECT_TRUE(thin.transmissive());
    EXPECT_FALSE(thin.refractive()) << "without a volume it is thin-walled";
    EXPECT_TRUE(std::isinf(thin.attenuation_distance));
}

TEST(LoadGltf, ValuesOutOfRangeAreClampedWithAWarning) {
    std::vector<std::string> warnings;
    EXPECT_EQ(material_of(extension("KHR_materials_ior", {{"ior", 0.5}}), &warnings).ior, 1.0f);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("material stuff: ior 0.5"), std::string::npos);
    EXPECT_EQ(material_of(extension("KHR_materials_ior", {{"ior", 0}}), &warnings).ior, 1.5f);
    EXPECT_EQ(warnings.size(), 1u);
    EXPECT_EQ(material_of(extension("KHR_materials_transmission", {{"transmissionFactor", 7}}), &warnings).transmission,
              1.0f);
    EXPECT_EQ(warnings.size(), 1u);
    EXPECT_GT(material_of(extension("KHR_materials_volume", {{"attenuationDistance", 0}})).attenuation_distance, 0.0f);
    EXPECT_EQ(material_of({{"pbrMetallicRoughness", {{"roughnessFactor", -3}}}}).roughness, 0.0f);
    EXPECT_EQ(material_of(extension("KHR_materials_ior", {{"ior", "glass"}})).ior, 1.5f);
    const Material blended = material_of({{"alphaMode", "BLEND"}}, &warnings);
    EXPECT_TRUE(blended.alpha_is_coverage && blended.has_holes());
    EXPECT_EQ(warnings.size(), 0u);
}

TEST(LoadGltf, GlassWithAlphaBlendingIsNotCutOut) {
    json glass = extension("KHR_materials_transmission", {{"transmissionFactor", 1}});
    glass["alphaMode"] = "BLEND";
    std::vector<std::string> warnings;
    EXPECT_EQ(material_of(glass, &warnings).alpha_cutoff, 0.0f);
    EXPECT_TRUE(warnings.empty()) << "alpha is 1";
    glass["pbrMetallicRoughness"] = {{"baseColorFactor", {1, 1, 1, 0.25}}};
    EXPECT_EQ(material_of(glass, &warnings).alpha_cutoff, 0.0f);
    EXPECT_TRUE(material_of(glass).alpha_is_coverage);
    EXPECT_TRUE(warnings.empty()) << "of thin glass, alpha is coverage";
    glass["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    EXPECT_FALSE(material_of(glass, &warnings).alpha_is_coverage);
    EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(),
                            [](const std::string& line) { return line.find("full coverage") != std::string::npos; }),
              1);
}

TEST(LoadGltf, DiffuseTransmission) {
    const json volume = {{"attenuationDistance", 2}, {"attenuationColor", {0.5, 0.25, 1}}};
    const json wax = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                      {"extensions",
                       {{"KHR_materials_diffuse_transmission",
                         {{"diffuseTransmissionFactor", 0.25}, {"diffuseTransmissionColorFactor", {0.9, 0.5, 0.1}}}},
                        {"KHR_materials_volume", volume}}}};
    std::vector<std::string> warnings;
    const Material material = material_of(wax, &warnings);
    EXPECT_TRUE(material.translucent());
    EXPECT_EQ(material.diffuse_transmission, 0.25f);
    EXPECT_EQ(material.diffuse_transmission_color, glm::vec3(0.9f, 0.5f, 0.1f));
    EXPECT_NEAR(material.sigma_a().r, std::log(2.0) / 2, 1e-6);
    EXPECT_NEAR(material.sigma_a().g, std::log(4.0) / 2, 1e-6);
    EXPECT_EQ(material.sigma_a().b, 0.0f);
    ASSERT_EQ(warnings.size(), 1u);  // the mesh is one triangle
    EXPECT_NE(warnings[0].find("not a closed solid"), std::string::npos);

    // Glass keeps to what goes straight through, metal scatters nothing, shares lie within 0..1.
    json glass = wax;
    glass["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 0.5}};
    EXPECT_FALSE(material_of(glass, &warnings).translucent());
    EXPECT_EQ(warnings.size(), 1u);
    EXPECT_FALSE(material_of({{"extensions", wax["extensions"]}}).translucent());
    json bright = wax;
    bright["extensions"]["KHR_materials_diffuse_transmission"]["diffuseTransmissionFactor"] = 3;
    EXPECT_EQ(material_of(bright, &warnings).diffuse_transmission, 1.0f);
    EXPECT_EQ(warnings.size(), 2u);
}

TEST(LoadGltf, OverridesApplyToRefractiveMaterialsOnly) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    const json glass = {{"extensions",
                         {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                          {"KHR_materials_volume", {{"thicknessFactor", 1}}}}}};
    b.root["materials"] = {
        glass, json::object(), {{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}}};
    LoadOptions options;
    options.ior = 2.4f;
    const Scene scene = load_scene(b.gltf(folder), options);
    EXPECT_EQ(scene.materials[0].ior, 2.4f);
    EXPECT_EQ(scene.materials[1].ior, 1.5f);
    EXPECT_EQ(scene.materials[2].ior, 1.5f);
}

TEST(LoadGltf, TexturesSamplersAndTransforms) {
    const TemporaryFolder folder;
    Image image(2, 1, 3);
    image.pixels = {1, 0, 0, 0, 1, 0};
    write_image(folder / "red green.png", image);
    GltfBuilder b = GltfBuilder::triangle();
    b.root["images"] = {{{"uri", "red%20green.png"}}};
    b.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    b.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
    b.root["extensionsUsed"] = {"KHR_texture_transform"};
    const json transform = {{"offset", {0.5, 0.25}}, {"rotation", kPi / 2}, {"scale", {2, 3}}, {"texCoord", 1}};
    b.root["materials"] = {
        {{"pbrMetallicRoughness",
          {{"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}},
           {"metallicRoughnessTexture", {{"index", 0}}}}}}};
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_EQ(broken_promise(scene), "");
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].pixels, image.pixels);
    EXPECT_EQ(scene.image_names[0], "red green.png");
    const Texture& texture = scene.materials[0].base_color_texture;
    EXPECT_EQ(texture.image, 0);
    EXPECT_EQ(texture.texcoord_set, 1);
    EXPECT_EQ(texture.wrap_u, Wrap::kClamp);
    EXPECT_EQ(texture.wrap_v, Wrap::kMirror);
    EXPECT_TRUE(texture.nearest);
    // Scaled to (2, 3), turned by a quarter with v downwards, then moved.
    const glm::vec3 uv = texture.uv_from_texcoord * glm::vec3(1, 1, 1);
    EXPECT_LT(glm::length(uv - glm::vec3(3.5f, -1.75f, 1)), 1e-5f) << uv.x << " " << uv.y;
    EXPECT_EQ(scene.materials[0].metallic_roughness_texture.image, 0);
    EXPECT_TRUE(scene.materials[0].metallic_roughness_texture.nearest);
}

TEST(LoadGltf, ImagesThatAreNoneGiveAWarningWithTheMaterial) {
    const TemporaryFolder folder;
    folder.file("text.png", "this is no image");
    GltfBuilder b = GltfBuilder::triangle();
    b.root["images"] = {{{"uri", "text.png"}},
                        {{"uri", "missing.png"}},
                        {{"bufferView", 99}},
                        {{"uri", "data:image/png;base64,AAAA"}},
                        json::object()};
    for (int i = 0; i < 6; ++i) {
        b.root["textures"].push_back({{"source", i}});
        b.root["materials"].push_back(
            {{"name", "m" + std::to_string(i)}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
    }
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_EQ(broken_promise(scene), "");
    EXPECT_TRUE(scene.images.empty());
    for (int i = 0; i < 6; ++i) {
        EXPECT_EQ(warnings_with(scene, "material m" + std::to_string(i) + ":"), 1u);
        EXPECT_EQ(scene.materials[std::size_t(i)].base_color_texture.image, -1);
    }
    EXPECT_EQ(warnings_with(scene, "missing.png"), 1u);
    b.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 77;
    EXPECT_NE(load_error(b.gltf(folder)).find("no texture 77"), std::string::npos);
}

TEST(LoadGltf, RefractiveMeshesAreRepaired) {
    const TemporaryFolder folder;
    GltfBuilder b;
    const Mesh mesh = cube();
    std::vector<float> positions, normals;
    std::vector<std::uint16_t> indices;
    for (const glm::vec3 p : mesh.positions)
        for (int k = 0; k < 3; ++k) positions.push_back(p[k]), normals.push_back(p[k]);
    for (const glm::uvec3 t : mesh.triangles)
        indices.insert(indices.end(), {std::uint16_t(t.y), std::uint16_t(t.x), std::uint16_t(t.z)});
    indices.insert(indices.end(), {0, 0, 1});
    json more = {{"indices", 0}, {"material", 0}};
    more["indices"] = b.attribute(indices, kUnsignedShort, "SCALAR", 1);
    b.mesh(
        {{"POSITION", b.attribute(positions, kFloat, "VEC3", 3)}, {"NORMAL", b.attribute(normals, kFloat, "VEC3", 3)}},
        more);
    b.node({{"mesh", 0}, {"scale", {-1, 1, 1}}});
    b.root["materials"] = {{{"extensions",
                             {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                              {"KHR_materials_volume", {{"thicknessFactor", 1}}}}}}};
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_EQ(broken_promise(scene), "");
    EXPECT_EQ(warnings_with(scene, "thing: was wound inside out, turned"), 1u)
        << "judged in its own frame, not in the mirrored one";
    EXPECT_EQ(warnings_with(scene, "thing: 1 triangle without area"), 1u);
    for (const glm::uvec3 t : scene.meshes[0].triangles)
        EXPECT_GT(glm::dot(face_normal(scene.meshes[0], t), scene.meshes[0].positions[t.x]), 0.0f);
    for (std::size_t v = 0; v < scene.meshes[0].positions.size(); ++v)
        EXPECT_GT(glm::dot(scene.meshes[0].normals[v], scene.meshes[0].positions[v]), 0.0f);
}

TEST(LoadGltf, RealFilesHaveTheirCounts) {
    const std::filesystem::path folder = data_folder() / "gltf";
    if (data_folder().empty()) GTEST_SKIP() << "PELLUCID_TEST_DATA does not name a folder";
    struct Known {
        const char* name;
        std::uint64_t triangles;
    };
    const Known table[] = {{"AnimatedMorphCube/glTF-Binary/AnimatedMorphCube.glb", 12},
                           {"AttenuationTest/glTF-Binary/AttenuationTest.glb", 292},
                           {"Box/glTF-Binary/Box.glb", 12},
                           {"ClearCoatTest/glTF-Binary/ClearCoatTest.glb", 37116},
                           {"Duck/glTF-Draco/Duck.gltf", 4212},
                           {"Duck/glTF-Quantized/Duck.gltf", 4212},
                           {"EmissiveStrengthTest/glTF-Binary/EmissiveStrengthTest.glb", 90},
                           {"GlassHurricaneCandleHolder/glTF-Binary/GlassHurricaneCandleHolder.glb", 4126},
                           {"GlassVaseFlowers/glTF-Binary/GlassVaseFlowers.glb", 14036},
                           {"IridescenceSuzanne/glTF-Binary/IridescenceSuzanne.glb", 11808},
                           {"MeshPrimitiveModes/glTF/MeshPrimitiveModes.gltf", 16},
                           {"MetalRoughSpheresNoTextures/glTF-Binary/MetalRoughSpheresNoTextures.glb", 1040409},
                           {"MosquitoInAmber/glTF/MosquitoInAmber.gltf", 14349},
                           {"SimpleInstancing/glTF-Binary/SimpleInstancing.glb", 1500},
                           {"SpecularTest/glTF-Binary/SpecularTest.glb", 44828},
                           {"SunglassesKhronos/SunglassesKhronos.glb", 13396},
                           {"TextureCoordinateTest/glTF-Binary/TextureCoordinateTest.glb", 10},
                           {"TextureTransformTest/glTF/TextureTransformTest.gltf", 24},
                           {"ToyCar/glTF/ToyCar.gltf", 108936},
                           {"TransmissionRoughnessTest/glTF-Binary/TransmissionRoughnessTest.glb", 77792},
                           {"TransmissionTest/glTF-Binary/TransmissionTest.glb", 128775},
                           {"Triangle/glTF-Embedded/Triangle.gltf", 1},
                           {"Triangle/glTF/Triangle.gltf", 1},
                           {"TriangleWithoutIndices/glTF/TriangleWithoutIndices.gltf", 1},
                           {"dispersion-test/dispersion-test.glb", 51827},
                           {"gen_DragonGlass/DragonGlass.glb", 100004}};
    for (const Known& known : table) {
        SCOPED_TRACE(known.name);
        const Scene scene = load_scene((folder / known.name).string());
        EXPECT_EQ(broken_promise(scene), "");
        EXPECT_EQ(scene.triangle_count(), known.triangles);
        EXPECT_EQ(warnings_with(scene, "image"), 0u) << "an image was not read";
    }
    EXPECT_NE(load_error((folder / "DragonAttenuation/glTF/DragonAttenuation.gltf").string())
                  .find("DragonAttenuation.bin: no such file"),
              std::string::npos);

    const Scene amber = load_scene((folder / "MosquitoInAmber/glTF/MosquitoInAmber.gltf").string());
    EXPECT_EQ(warnings_with(amber, "no such file"), 3u);
    const Scene dragon = load_scene((folder / "gen_DragonGlass/DragonGlass.glb").string());
    EXPECT_TRUE(dragon.warnings.empty());
    const Scene prisms = load_scene((folder / "dispersion-test/dispersion-test.glb").string());
    EXPECT_GT(std::count_if(prisms.materials.begin(), prisms.materials.end(),
                            [](const Material& m) { return m.dispersion > 0; }),
              3);
}

}  // namespace
}  // namespace pellucid
