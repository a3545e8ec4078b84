// Textures of glTF files in all the ways that extensions store them, and materials that are converted.
#include "gltf_builder.h"
#include "test_files.h"
#include "test_meshes.h"

#include <pellucid/image.h>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

using namespace test;

/// 2 x 1 pixels of WebP, and the beginning of a KTX2 file.
constexpr const char* kWebp =
    "data:image/webp;base64,UklGRk4AAABXRUJQVlA4IEIAAABwAgCdASoCAAEAAAAAJaACdLoB+AH6AAMyrEZgAP7//353/6xQf/Sw//AAMf/7"
    "wEgSujD/vAX/+ZE7zbV3/5iAAAA=";
constexpr const char* kKtx2 = "data:image/ktx2;base64,q0tUWCAyMLsNChoKAAAAAAEAAAA=";

std::string png(const TemporaryFolder& folder, const std::string& name, const std::vector<float>& pixels,
                int channels) {
    Image image(int(pixels.size()) / channels, 1, channels);
    image.pixels = pixels;
    write_image(folder / name, image);
    return name;
}

/// The triangle with one material.
GltfBuilder with_material(json material) {
    GltfBuilder b = GltfBuilder::triangle();
    material["name"] = "stuff";
    b.root["materials"] = {std::move(material)};
    b.root["meshes"][0]["primitives"][0]["material"] = 0;
    return b;
}

json base_color(int texture, int texcoord = 0) {
    return {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}, {"texCoord", texcoord}}}}}};
}

TEST(GltfTextures, WebpTakesTheImageOfTheExtension) {
    const TemporaryFolder folder;
    GltfBuilder b = with_material(base_color(0));
    b.root["images"] = {{{"uri", png(folder, "a.png", {1, 1, 1}, 3)}}, {{"uri", kWebp}}};
    b.root["textures"] = {{{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}}};
    b.root["extensionsUsed"] = b.root["extensionsRequired"] = {"EXT_texture_webp"};
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].width, 2);
}

TEST(GltfTextures, Ktx2IsLeftOutOfOpaqueMaterialsAndRefusedForGlass) {
    const TemporaryFolder folder;
    GltfBuilder b = with_material(base_color(0));
    b.root["images"] = {{{"uri", kKtx2}}, {{"uri", png(folder, "a.png", {1, 1, 1}, 3)}}};
    b.root["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
    b.root["extensionsUsed"] = b.root["extensionsRequired"] = {"KHR_texture_basisu"};
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_TRUE(scene.images.empty());
    EXPECT_EQ(scene.materials[0].base_color_texture.image, -1);
    EXPECT_EQ(scene.warnings, std::vector<std::string>{"a.gltf: 1 texture left out: KTX2 images (KHR_texture_basisu) "
                                                       "are not decoded; export the file with PNG or JPEG images"});
    const json opaque = b.root;
    b.root["materials"][0]["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
    EXPECT_NE(load_error(b.gltf(folder)).find("a.gltf: material stuff: glass with a texture of KTX2"),
              std::string::npos);

    // An image of another format stands in for it.
    b.root["textures"][0]["source"] = 1;
    const Scene other = load_scene(b.gltf(folder));
    EXPECT_EQ(other.images.size(), 1u);
    EXPECT_TRUE(other.warnings.empty());
    b.root = opaque;
    b.root["textures"] = {{{"source", 0}}};
    EXPECT_EQ(warnings_with(load_scene(b.gltf(folder)), "1 texture left out: KTX2"), 1u)
        << "named without the extension";
}

TEST(GltfTextures, AnyTwoSetsOfCoordinates) {
    const TemporaryFolder folder;
    GltfBuilder b = with_material(base_color(0, 3));
    json& material = b.root["materials"][0];
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {
        {"index", 0}, {"texCoord", 0}, {"extensions", {{"KHR_texture_transform", {{"texCoord", 2}}}}}};
    b.root["images"] = {{{"uri", png(folder, "a.png", {1, 1, 1}, 3)}}};
    b.root["textures"] = {{{"source", 0}}};
    for (int set = 0; set < 4; ++set) {
        const float u = float(set);
        b.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_" + std::to_string(set)] =
            b.attribute<float>({u, 0, u, 1, u, 0}, kFloat, "VEC2", 2);
    }
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_TRUE(scene.warnings.empty());
    const auto u_of = [&](const Texture& texture) { return scene.meshes[0].texcoords[texture.texcoord_set].at(0).x; };
    EXPECT_EQ(u_of(scene.materials[0].base_color_texture), 3.0f);
    EXPECT_EQ(u_of(scene.materials[0].metallic_roughness_texture), 2.0f) << "the transform's set wins";

    material["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
    material["emissiveFactor"] = {1, 1, 1};
    const Scene three = load_scene(b.gltf(folder));
    EXPECT_EQ(warnings_with(three, "material stuff: emission texture left out: a material may use two sets"), 1u);
}

TEST(GltfTextures, ManyImagesComeInTheOrderOfTheirUse) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    constexpr int kCount = 24;
    for (int i = 0; i < kCount; ++i) {
        const std::string name = std::to_string(i) + ".png";
        png(folder, name, std::vector<float>(std::size_t(3 * (kCount - i)), 0.0f), 3);
        b.root["images"].push_back({{"uri", name}});
        b.root["textures"].push_back({{"source", i}});
        b.root["materials"].push_back(base_color(i));
    }
    b.root["images"].push_back({{"uri", "unused.png"}});
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_TRUE(scene.warnings.empty()) << "the image that is not there is not used";
    ASSERT_EQ(scene.images.size(), std::size_t(kCount));
    for (int i = 0; i < kCount; ++i) {
        EXPECT_EQ(scene.materials[std::size_t(i)].base_color_texture.image, i);
        EXPECT_EQ(scene.images[std::size_t(i)].width, kCount - i);
    }
}

// --- KHR_materials_pbrSpecularGlossiness ------------------------------------------------------------------

Material converted(json properties) {
    const TemporaryFolder folder;
    json material;
    material["extensions"]["KHR_materials_pbrSpecularGlossiness"] = std::move(properties);
    const Scene scene = load_scene(with_material(material).gltf(folder));
    EXPECT_EQ(warnings_with(scene, "1 material of specular-glossiness, converted to metallic-roughness"), 1u);
    return scene.materials.at(0);
}

TEST(SpecularGlossiness, DielectricsAndMetalsStayWhatTheyAre) {
    const Material plastic = converted({{"diffuseFactor", {0.5, 0.25, 0.125, 0.75}},
                                        {"specularFactor", {0.04, 0.04, 0.04}},
                                        {"glossinessFactor", 0.7}});
    EXPECT_NEAR(plastic.metallic, 0.0f, 1e-5f);
    EXPECT_NEAR(plastic.roughness, 0.3f, 1e-6f);
    EXPECT_LT(glm::length(plastic.base_color - glm::vec4(0.5, 0.25, 0.125, 0.75)), 1e-5f);

    const Material gold =
        converted({{"diffuseFactor", {0, 0, 0, 1}}, {"specularFactor", {1.0, 0.77, 0.34}}, {"glossinessFactor", 1}});
    EXPECT_NEAR(gold.metallic, 1.0f, 1e-5f);
    EXPECT_EQ(gold.roughness, 0.0f);
    EXPECT_LT(glm::length(gold.base_color - glm::vec4(1.0, 0.77, 0.34, 1)), 1e-4f);
}

TEST(SpecularGlossiness, TexturesAreConvertedTexelByTexel) {
    const TemporaryFolder folder;
    json properties = {{"diffuseTexture", {{"index", 0}}}, {"specularGlossinessTexture", {{"index", 1}}}};
    json material;
    material["extensions"]["KHR_materials_pbrSpecularGlossiness"] = properties;
    GltfBuilder b = with_material(material);
    // A black metal that reflects all beside a red dielectric; 0.04 is 56.5 / 255 in sRGB.
    const float dielectric = 56.5f / 255.0f;
    b.root["images"] = {{{"uri", png(folder, "d.png", {0, 0, 0, 1, 1, 0, 0, 0.5f}, 4)}},
                        {{"uri", png(folder, "s.png", {1, 1, 1, 1, dielectric, dielectric, dielectric, 0}, 4)}}};
    b.root["textures"] = {{{"source", 0}}, {{"source", 1}}};
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_EQ(broken_promise(scene), "");
    const Material& m = scene.materials.at(0);
    ASSERT_EQ(scene.images.size(), 2u);
    const Image& base = scene.images[std::size_t(m.base_color_texture.image)];
    const Image& rough = scene.images[std::size_t(m.metallic_roughness_texture.image)];
    ASSERT_EQ(base.width, 2);
    EXPECT_EQ(m.metallic, 1.0f);
    EXPECT_EQ(m.roughness, 1.0f);
    EXPECT_NEAR(base.at(0, 0)[0], 1.0f, 0.01f);
    EXPECT_NEAR(rough.at(0, 0)[1], 0.0f, 0.01f);
    EXPECT_NEAR(rough.at(0, 0)[2], 1.0f, 0.01f);
    EXPECT_NEAR(base.at(1, 0)[0], 1.0f, 0.01f);
    EXPECT_NEAR(base.at(1, 0)[1], 0.0f, 0.01f);
    EXPECT_NEAR(base.at(1, 0)[3], 0.5f, 0.01f);
    EXPECT_NEAR(rough.at(1, 0)[1], 1.0f, 0.01f);
    EXPECT_NEAR(rough.at(1, 0)[2], 0.0f, 0.02f);

    properties["specularGlossinessTexture"]["texCoord"] = 1;
    b.root["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] = properties;
    EXPECT_EQ(warnings_with(load_scene(b.gltf(folder)), "its mean is used"), 1u);
}

TEST(SpecularGlossiness, TexturesThatWouldMakeAGiantAreNotCombined) {
    const TemporaryFolder folder;
    json material;
    material["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {{"diffuseTexture", {{"index", 0}}},
                                                                     {"specularGlossinessTexture", {{"index", 1}}}};
    GltfBuilder b = with_material(material);
    write_image(folder / "wide.png", Image(65535, 1, 3));
    write_image(folder / "high.png", Image(1, 65535, 3));
    b.root["images"] = {{{"uri", "wide.png"}}, {{"uri", "high.png"}}};
    b.root["textures"] = {{{"source", 0}}, {{"source", 1}}};
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_EQ(warnings_with(scene, "make more than 2^28 pixels, the mean of the second is used"), 1u);
    ASSERT_EQ(scene.images.size(), 2u);
    EXPECT_EQ(scene.images[0].width, 65535);
    EXPECT_EQ(scene.images[0].height, 1);
}

// --- files ----------------------------------------------------------------------------------------------

TEST(GltfFiles, ChunksThatAreNotFilledUp) {
    for (std::size_t blanks = 0; blanks < 4; ++blanks) {
        const TemporaryFolder folder;
        GltfBuilder b = GltfBuilder::triangle();
        b.root["asset"]["generator"] = std::string(blanks, 'x');
        b.root["buffers"] = {{{"byteLength", b.bin.size()}}};
        const std::string text = b.root.dump();
        std::string bytes = "glTF";
        const auto u32 = [&](std::size_t value) {
            const auto v = static_cast<std::uint32_t>(value);
            bytes.append(reinterpret_cast<const char*>(&v), 4);
        };
        u32(2);
        u32(12 + 8 + text.size() + 8 + b.bin.size());
        u32(text.size());
        bytes += "JSON" + text;
        u32(b.bin.size());
        bytes.append("BIN\0", 4);
        EXPECT_EQ(load_error(folder.file("a.glb", bytes + b.bin)), "");
    }
}

TEST(GltfFiles, UrisInEveryForm) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    const std::string file = b.gltf(folder);
    const std::string base64 = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    std::filesystem::create_directory(folder / "sub");
    folder.file("sub/a b.bin", b.bin);
    folder.file("100%25.bin", b.bin);
    for (const char* const uri :
         {"sub/a%20b.bin", "sub/a b.bin", "sub\\a b.bin", "./sub/a%20b.bin", "100%25.bin", "100%2525.bin"})
        EXPECT_EQ((b.root["buffers"][0]["uri"] = uri, load_error(folder.file("b.gltf", b.root.dump()))), "") << uri;
    for (const char* const head :
         {"data:;base64,", "data:application/x-bin;charset=utf-8;base64,", "data:model/gltf-buffer;base64,"})
        EXPECT_EQ((b.root["buffers"][0]["uri"] = head + base64, load_error(folder.file("b.gltf", b.root.dump()))), "")
            << head;
    b.root["buffers"][0]["uri"] = "https://example.org/a.bin";
    EXPECT_NE(
        load_error(folder.file("b.gltf", b.root.dump())).find("buffer 0: https://example.org/a.bin: is on a network"),
        std::string::npos);
    EXPECT_EQ(load_error(folder.file("bom.gltf", "\xef\xbb\xbf" + content_of(file))), "");
}

TEST(GltfFiles, PipesAreNoImages) {
    const TemporaryFolder folder;
    GltfBuilder b = with_material(base_color(0));
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    b.root["images"] = {{{"uri", "pipe"}}};
    b.root["textures"] = {{{"source", 0}}};
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_EQ(warnings_with(scene, "is not a regular file"), 1u);
    EXPECT_TRUE(scene.images.empty());
}

TEST(GltfFiles, WholeNumbersMayHaveAPoint) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    b.root["accessors"][0]["count"] = 3.0;
    b.root["nodes"][0]["mesh"] = 0.0;
    b.root["scenes"][0]["nodes"] = {0.0};
    EXPECT_EQ(load_error(b.gltf(folder)), "");
}

TEST(GltfFiles, MatricesMayBeRounded) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    b.root["nodes"][0]["matrix"] = {1, 0, 0, 1e-9, 0, 1, 0, 0, 0, 0, 1, 0, 7, 0, 0, 1.0000001};
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_EQ(broken_promise(scene), "");
    EXPECT_EQ(scene.objects.at(0).world_from_object[0][3], 0.0f);
}

TEST(GltfFiles, IndicesMayBeSparse) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    const int which = b.view<std::uint8_t>({1, 2}), values = b.view<std::uint16_t>({1, 2});
    b.root["meshes"][0]["primitives"][0]["indices"] =
        b.accessor(-1, kUnsignedShort, "SCALAR", 3,
                   {{"sparse",
                     {{"count", 2},
                      {"indices", {{"bufferView", which}, {"componentType", kUnsignedByte}}},
                      {"values", {{"bufferView", values}}}}}});
    EXPECT_EQ(load_scene(b.gltf(folder)).meshes.at(0).triangles.at(0), glm::uvec3(0, 1, 2));
}

TEST(GltfFiles, MessagesNameTheAccessor) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    b.root["accessors"][0]["count"] = 1000;
    EXPECT_NE(
        load_error(b.gltf(folder)).find("a.gltf: mesh thing primitive 0 POSITION (accessor 0): 1000 elements reach"),
        std::string::npos);
}

}  // namespace
}  // namespace pellucid
