// Materials of OBJ files.
#include "core/math.h"
#include "test_files.h"
#include "test_meshes.h"

#include <pellucid/image.h>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

namespace pellucid {
namespace {

using test::broken_promise;
using test::TemporaryFolder;
using test::warnings_with;

/// Cubes beside each other, one per name, each with that material.
std::string cubes(const std::vector<std::string>& materials, const std::string& library = "mtllib a.mtl\n") {
    std::string text = library + "vt 0 0\nvt 1 0\nvt 0 0.25\n";
    int first = 1;
    for (const std::string& material : materials) {
        const Mesh cube = test::cube(1.0f, glm::vec3(2.0f * float(first) / 8.0f, 0.0f, 0.0f));
        for (const glm::vec3 p : cube.positions) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
        text += "usemtl " + material + "\n";
        for (const glm::uvec3 t : cube.triangles)
            text += fmt::format("f {}/1 {}/2 {}/3\n", int(t.x) + first, int(t.y) + first, int(t.z) + first);
        first += 8;
    }
    return text;
}

class ObjMaterials : public testing::Test {
protected:
    /// A cube of material "a", with these statements.
    Scene load(const std::string& statements, const LoadOptions& options = {}) {
        folder_.file("a.mtl", "newmtl a\n" + statements);
        Scene scene = load_scene(folder_.file("a.obj", cubes({"a"})), options);
        EXPECT_EQ(broken_promise(scene), "");
        EXPECT_EQ(scene.objects.size(), 1u);
        return scene;
    }
    Material material(const std::string& statements) { return load(statements).materials.at(0); }
    std::size_t warnings(const std::string& statements, std::string_view text) {
        return warnings_with(load(statements), text);
    }

    TemporaryFolder folder_;
};

TEST_F(ObjMaterials, GlassBesideWood) {
    folder_.file("a.mtl",
                 "newmtl wood\nKd .5 .3 .1\nd 1\nillum 2\nnewmtl glass\nKd 1 1 1\nNi 1.33\nd 0.1\nTf .9 1 .9\nillum 7\n"
                 "newmtl wax\nKd .8 .1 .1\n");
    const std::string file = folder_.file("a.obj", cubes({"wood", "glass", "wax", "wood"}));
    const Scene scene = load_scene(file);
    EXPECT_EQ(broken_promise(scene), "");
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    ASSERT_EQ(scene.objects.size(), 3u);
    EXPECT_EQ(scene.triangle_count(), 48u);
    EXPECT_EQ(scene.objects[0].name, "wood");
    EXPECT_EQ(scene.objects[1].name, "glass");
    EXPECT_EQ(scene.meshes[0].triangles.size(), 24u);
    const Material& wood = scene.materials[0];
    EXPECT_EQ(wood.base_color, glm::vec4(0.5f, 0.3f, 0.1f, 1.0f));
    EXPECT_FALSE(wood.transmissive());
    EXPECT_EQ(wood.roughness, 1.0f);
    const Material& glass = scene.materials[1];
    EXPECT_TRUE(glass.refractive());
    EXPECT_EQ(glass.ior, 1.33f);
    EXPECT_EQ(glass.transmission, 1.0f);
    EXPECT_EQ(glass.base_color, glm::vec4(0.9f, 1.0f, 0.9f, 1.0f));
    EXPECT_EQ(scene.materials[2].base_color, glm::vec4(0.8f, 0.1f, 0.1f, 1.0f));
    // Options hold for the glass, and for it alone.
    LoadOptions options;
    options.ior = 1.7f;
    options.attenuation_color = glm::vec3(0.5f);
    const Scene other = load_scene(file, options);
    ASSERT_EQ(other.objects.size(), 3u);
    EXPECT_EQ(other.materials[1].ior, 1.7f);
    EXPECT_EQ(other.materials[1].attenuation_color, glm::vec3(0.5f));
    EXPECT_EQ(other.materials[0].ior, 1.5f);
}

TEST_F(ObjMaterials, WhatIsGlass) {
    for (const char* glass : {"illum 4", "illum 6", "illum 7\nd 1", "illum 9\nNi 1.2", "d 0.5\nNi 1.5",
                              "Tr 0.5\nNi 1.5", "d 0.5\nTf 1 1 1", "Tf 1\nPr 0.1\nPm 0", "ILLUM 4", "d 0\nNi 1.5"})
        EXPECT_TRUE(material(glass).refractive()) << glass;
    for (const char* opaque : {"", "illum 2", "illum 3", "d 1\nNi 1.5\nTf 1 1 1", "Tr 0\nNi 1.5", "Tr 1\nd 1\nNi 1.5",
                               "d 1\nTr 1\nNi 1.5", "illum 4\nKd .5 .5 .5\nTf 1 1 1\nNi 1.0",
                               "illum 4\nTf 1.00 1.00 1.00", "Tr 1\nNi 1.5", "Tf 0 0 0\nPr 0.1", "Ni 1.5"})
        EXPECT_FALSE(material(opaque).transmissive()) << opaque;
    // Without an index there is nothing to bend light by: the surface covers a part of what lies behind it.
    const Material veil = material("d 0.25\nNi 1\nKd 1 0 0");
    EXPECT_FALSE(veil.transmissive());
    EXPECT_TRUE(veil.alpha_is_coverage);
    EXPECT_EQ(veil.base_color, glm::vec4(1.0f, 0.0f, 0.0f, 0.25f));
    EXPECT_EQ(warnings("illum 4", "glass without Ni: index of refraction 1.5 used"), 1u);
    EXPECT_EQ(warnings("illum 4\nNi 0.2", "Ni 0.2 is out of range, 1.5 used"), 1u);
    EXPECT_EQ(material("illum 4\nNi 0.2").ior, 1.5f);
    EXPECT_EQ(warnings("illum 7\nNi 1", "glass of Ni 1 bends no light"), 1u);
}

TEST_F(ObjMaterials, ColoursOfGlass) {
    const auto color = [&](const char* statements) { return glm::vec3(material(statements).base_color); };
    EXPECT_EQ(color("illum 7\nNi 1.5\nKd 0 0 0\nTf 0.5 0.6 0.7"), glm::vec3(0.5f, 0.6f, 0.7f));
    EXPECT_EQ(color("illum 7\nNi 1.5\nKd 0 0 0"), glm::vec3(1.0f));
    EXPECT_EQ(color("illum 7\nNi 1.5\nKd 1 0.5 0"), glm::vec3(1.0f, 0.5f, 0.0f));
    EXPECT_EQ(color("d 0.5\nNi 1.5\nKd 1 0 0"), glm::vec3(1.0f, 0.5f, 0.5f));
    EXPECT_EQ(color("d 0.5\nNi 1.5\nKd 1 0 0\nTf 0 0 0"), glm::vec3(1.0f, 0.5f, 0.5f));
    EXPECT_EQ(color("Tf 1 1 1\nPr 0.3\nKd 0.2 0.4 0.6"), glm::vec3(0.2f, 0.4f, 0.6f));
    EXPECT_EQ(material("Tf 1 1 1\nPr 0.3").roughness, 0.3f);
}

TEST_F(ObjMaterials, OpaqueSurfaces) {
    EXPECT_EQ(material("Kd 0.5").base_color, glm::vec4(0.5f, 0.5f, 0.5f, 1.0f));
    EXPECT_EQ(material("Kd 2 -1 .1e1").base_color, glm::vec4(1.0f, 0.0f, 1.0f, 1.0f));
    EXPECT_NEAR(material("Kd xyz 0.9505 1 1.089").base_color.g, 1.0f, 1e-3f);
    EXPECT_NEAR(material("Ks 1 1 1\nNs 198").roughness, std::sqrt(0.1f), 1e-6f);
    EXPECT_EQ(material("Ks 1 1 1\nNs 198\nillum 1").roughness, 1.0f);
    EXPECT_EQ(material("Ks 0 0 0\nNs 198").roughness, 1.0f);
    EXPECT_EQ(material("Pr 0.25\nPm 0.5").roughness, 0.25f);
    EXPECT_EQ(material("Pr 0.25\nPm 0.5").metallic, 0.5f);
    const Material mirror = material("Kd 0.1 0 0\nKs 0.9 0.8 0.7\nNs 1000\nillum 3");
    EXPECT_EQ(mirror.metallic, 1.0f);
    EXPECT_EQ(mirror.base_color, glm::vec4(0.9f, 0.8f, 0.7f, 1.0f));
    EXPECT_EQ(material("Kd 0.9 0 0\nKs 0.3 0.3 0.3\nillum 3").metallic, 0.0f);
    EXPECT_EQ(material("Ke 3 2 1").emission, glm::vec3(3.0f, 2.0f, 1.0f));
    EXPECT_TRUE(material("Kd 1 1 1").double_sided);
    EXPECT_EQ(warnings("Kd 1 x 1", "a.mtl: line 2: \"x\" is no number, left out"), 1u);
    EXPECT_EQ(warnings("Kd spectral a.rfl", "a.mtl: line 2: a spectral curve, left out"), 1u);
    EXPECT_EQ(warnings("disp a.png\nPc 0\nmap_Ks b.png", "material a: disp, map_ks not used"), 1u);
}

TEST_F(ObjMaterials, Textures) {
    Image image(2, 2, 3);
    image.pixels = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    write_image(folder_ / "wood grain.png", image);
    std::filesystem::create_directory(folder_ / "maps");
    write_image(folder_ / "maps/Leaf.png", Image(4, 4, 1));
    for (const char* name : {"wood grain.png", "\"wood grain.png\"", "Wood Grain.PNG", "C:\\images\\wood grain.png",
                             "/home/other/wood grain.png", "-blendu off -mm 0 1 -clamp off wood grain.png"}) {
        const Scene scene = load(fmt::format("Kd 0 0 0\nmap_Kd {}", name));
        const Material& m = scene.materials[0];
        ASSERT_EQ(m.base_color_texture.image, 0) << name;
        EXPECT_EQ(m.base_color, glm::vec4(1.0f)) << "beside a texture black is no colour";
        ASSERT_FALSE(scene.meshes[0].texcoords[0].empty());
        // The corner (0, 0.25) of the file, whose v runs upwards.
        bool found = false;
        for (const glm::vec2 t : scene.meshes[0].texcoords[0]) found = found || t == glm::vec2(0.0f, 0.75f);
        EXPECT_TRUE(found);
    }
    EXPECT_EQ(material("Kd 0.5 0.5 0.5\nmap_Kd wood grain.png").base_color.r, 0.5f);
    const Texture moved = material("map_Kd -s 2 3 1 -o 0.5 0.25 -clamp on wood grain.png").base_color_texture;
    EXPECT_EQ(moved.wrap_u, Wrap::kClamp);
    const glm::vec3 uv = moved.uv_from_texcoord * glm::vec3(0.1f, 1.0f - 0.2f, 1.0f);  // of u 0.1, v 0.2 upwards
    EXPECT_NEAR(uv.x, 2.0f * 0.1f + 0.5f, 1e-6f);
    EXPECT_NEAR(1.0f - uv.y, 3.0f * 0.2f + 0.25f, 1e-6f);
    const Scene leaf = load("map_Kd wood grain.png\nmap_d maps\\leaf.png\nillum 9\nd 1");
    EXPECT_FALSE(leaf.materials[0].transmissive());
    EXPECT_EQ(leaf.materials[0].alpha_cutoff, 0.5f);
    ASSERT_EQ(leaf.images.size(), 1u);
    EXPECT_EQ(leaf.images[0].channels, 4);
    EXPECT_EQ(leaf.images[0].width, 4);
    EXPECT_EQ(leaf.images[0].at(0, 0)[0], 1.0f);
    EXPECT_EQ(leaf.images[0].at(0, 0)[3], 0.0f);
    EXPECT_EQ(material("map_Ke wood grain.png").emission, glm::vec3(1.0f));
    EXPECT_EQ(material("norm wood grain.png").normal_texture.image, 0);
    EXPECT_EQ(material("map_Ke none.png").emission, glm::vec3(0.0f));
    EXPECT_EQ(material("map_d none.png").alpha_cutoff, 0.0f);
    EXPECT_EQ(warnings("map_Kd no such.png", "material a: texture left out: no such.png: no such file"), 1u);
    folder_.file("broken.png", "x");
    EXPECT_EQ(warnings("map_Kd broken.png", "material a: texture left out: "), 1u);
    folder_.file("a.mtl", "newmtl a\nmap_Kd wood grain.png\n");
    EXPECT_EQ(
        warnings_with(load_scene(folder_.file("b.obj", "mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")),
                      "its texture has no coordinates in the file"),
        1u);
}

TEST_F(ObjMaterials, WideCutOuts) {
    Image color(50000, 1, 3), cover(50000, 1, 1);
    color.at(49999, 0)[1] = cover.at(49999, 0)[0] = 1.0f;
    write_image(folder_ / "color.png", color);
    write_image(folder_ / "cover.png", cover);
    const Scene wide = load("map_Kd color.png\nmap_d cover.png");
    ASSERT_EQ(wide.images.size(), 1u);
    for (const int x : {0, 44000, 49998, 49999}) {
        const float expected = x == 49999 ? 1.0f : 0.0f;
        EXPECT_EQ(wide.images[0].at(x, 0)[1], expected) << x;
        EXPECT_EQ(wide.images[0].at(x, 0)[3], expected) << x;
    }
    // Together they would have 4 G pixels.
    write_image(folder_ / "wide.png", Image(65535, 1, 1));
    write_image(folder_ / "high.png", Image(1, 65535, 1));
    const Scene apart = load("map_Kd wide.png\nmap_d high.png");
    ASSERT_EQ(apart.images.size(), 1u);
    EXPECT_EQ(apart.images[0].height, 1);
    EXPECT_EQ(warnings_with(apart, "make more than 2^28"), 1u);
}

TEST_F(ObjMaterials, BumpMaps) {
    // Heights that rise by a half per texel along u and fall by a quarter along the rows, where v runs upwards.
    Image heights(3, 3, 1);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x) heights.at(x, y)[0] = 0.25f * float(2 * x - y);
    write_image(folder_ / "heights.exr", heights);
    for (const char* statement : {"map_Bump -bm 2", "bump -bm 2"}) {
        const Scene scene = load(fmt::format("{} heights.exr", statement));
        EXPECT_EQ(warnings_with(scene, "not used"), 0u);
        ASSERT_EQ(scene.materials[0].normal_texture.image, 0);
        const float* const encoded = scene.images[0].at(1, 1);
        const glm::vec3 normal = glm::vec3(encoded[0], encoded[1], encoded[2]) * 2.0f - 1.0f;
        const glm::vec3 expected = glm::normalize(glm::vec3(-2.0f * 0.5f, -2.0f * 0.25f, 1.0f));
        EXPECT_NEAR(glm::length(normal - expected), 0.0f, 1e-6f);
    }
    // At the left edge heights fall where the image repeats, and rise where it is clamped.
    const auto left = [](const Scene& scene) { return scene.images[0].at(0, 1)[0] * 2.0f - 1.0f; };
    EXPECT_GT(left(load("bump heights.exr")), 0.0f);
    EXPECT_LT(left(load("bump -clamp on heights.exr")), 0.0f);

    // A coloured image has normals, as Blender writes them.
    Image normals(1, 1, 3);
    normals.pixels = {0.8f, 0.5f, 0.9f};
    write_image(folder_ / "normals.exr", normals);
    const Scene scene = load("map_Bump -bm 0.5 normals.exr");
    const float* const encoded = scene.images.at(0).at(0, 0);
    EXPECT_NEAR((encoded[0] * 2.0f - 1.0f) / (encoded[2] * 2.0f - 1.0f), 0.5f * 0.6f / 0.8f, 1e-5f);
    EXPECT_EQ(warnings("illum 7\nbump heights.exr", "map_Bump of glass is not used"), 1u);
}

TEST_F(ObjMaterials, RoughnessAndMetalMaps) {
    Image rough(2, 1, 1), metal(1, 1, 1);
    rough.pixels = {0.25f, 0.75f};
    metal.pixels = {0.5f};
    write_image(folder_ / "rough.exr", rough);
    write_image(folder_ / "metal.exr", metal);
    const Scene both = load("Pr 0.1\nmap_Pr rough.exr\nmap_Pm metal.exr");
    ASSERT_EQ(both.materials[0].metallic_roughness_texture.image, 0);
    EXPECT_EQ(both.materials[0].roughness, 1.0f);
    EXPECT_EQ(both.materials[0].metallic, 1.0f);
    EXPECT_EQ(both.images[0].at(1, 0)[1], 0.75f);
    EXPECT_EQ(both.images[0].at(1, 0)[2], 0.5f);
    const Scene one = load("Pm 0.5\nmap_Pr rough.exr");
    EXPECT_EQ(one.images[0].at(0, 0)[1], 0.25f);
    EXPECT_EQ(one.images[0].at(0, 0)[2], 1.0f);
    EXPECT_EQ(one.materials[0].metallic, 0.5f);
}

TEST_F(ObjMaterials, LibrariesAndNames) {
    const std::string glass = "Ni 1.2\nillum 4\n";
    folder_.file("my materials.mtl", "newmtl deep blue\n" + glass);
    folder_.file("second.mtl",
                 "\xef\xbb\xbf"
                 "newmtl other\r\n"
                 "Kd 1 0 0\r\n");
    const auto first_ior = [&](const std::string& library, const std::string& name = "deep blue") {
        const Scene scene = load_scene(folder_.file("a.obj", cubes({name}, library)));
        EXPECT_EQ(warnings_with(scene, "a.obj: no such material file"), 0u) << library;
        return scene.materials.at(0).ior;
    };
    EXPECT_EQ(first_ior("mtllib my materials.mtl\n"), 1.2f);
    EXPECT_EQ(first_ior("mtllib My Materials.MTL\r\n", "deep blue  \t"), 1.2f);
    EXPECT_EQ(first_ior("mtllib X:\\work\\my materials.mtl\n"), 1.2f);
    EXPECT_EQ(first_ior("mtllib second.mtl\nmtllib my materials.mtl\n"), 1.2f);
    const Scene two = load_scene(folder_.file("b.obj", cubes({"other"}, "mtllib second.mtl third.mtl\n")));
    EXPECT_EQ(two.materials.at(0).base_color, glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
    EXPECT_EQ(warnings_with(two, "b.obj: no such material file: third.mtl"), 1u);

    const Scene none = load_scene(folder_.file("c.obj", cubes({"a", "b"}, "mtllib none.mtl\n")));
    EXPECT_EQ(none.objects.size(), 1u);
    EXPECT_TRUE(none.materials[0].refractive());
    EXPECT_EQ(warnings_with(none, "c.obj: no such material file: none.mtl: the whole file is glass"), 1u);
    const Scene unnamed = load_scene(folder_.file("d.obj", cubes({"a", "b"}, "")));
    EXPECT_EQ(warnings_with(unnamed, "d.obj: 2 materials are in no material file: the whole file is glass"), 1u);

    folder_.file("a.mtl", "newmtl a\n" + glass);
    const Scene some = load_scene(folder_.file("e.obj", cubes({"a", "b"}) + "usemtl\nf 1 2 3\n"));
    EXPECT_EQ(warnings_with(some, "e.obj: material in no material file, drawn matt grey: b"), 1u);
    EXPECT_EQ(warnings_with(some, "e.obj: faces without a material, drawn matt grey"), 1u);
    ASSERT_EQ(some.objects.size(), 3u);
    EXPECT_EQ(some.objects[2].name, "e");
    std::filesystem::create_directory(folder_ / "folder.mtl");
    EXPECT_EQ(warnings_with(load_scene(folder_.file("f.obj", cubes({"a"}, "mtllib folder.mtl\n"))), "no such material"),
              1u);
}

TEST_F(ObjMaterials, FilesWithoutGlass) {
    const Scene opaque = load("Kd 0.5 0.5 0.5\n");
    EXPECT_FALSE(opaque.materials[0].transmissive());
    EXPECT_EQ(warnings_with(opaque, "a.obj: none of its materials is glass; --ior 1.5 draws the whole file as glass"),
              1u);
    LoadOptions options;
    options.ior = 1.6f;
    const Scene glass = load("Kd 0.5 0.5 0.5\n", options);
    EXPECT_TRUE(glass.materials[0].refractive());
    EXPECT_EQ(glass.materials[0].ior, 1.6f);
    EXPECT_EQ(warnings_with(glass, "a.obj: its materials are left out: none is glass, and glass was asked for"), 1u);
}

TEST_F(ObjMaterials, OneSolidOfSeveralMaterialsAndPanes) {
    const Mesh cube = test::cube();
    std::string text = "mtllib a.mtl\n";
    for (const glm::vec3 p : cube.positions) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    for (std::size_t i = 0; i < cube.triangles.size(); ++i) {
        const glm::uvec3 t = cube.triangles[i] + 1u;
        text += fmt::format("usemtl {}\nf {} {} {}\n", i < 6 ? "a" : "b", t.x, t.y, t.z);
    }
    folder_.file("a.mtl", "newmtl a\nillum 4\nNi 1.5\nKd 1 0 0\nnewmtl b\nillum 4\nNi 1.5\nKd 0 1 0\n");
    const Scene scene = load_scene(folder_.file("a.obj", text));
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_GE(scene.objects[0].body, 0);
    EXPECT_EQ(scene.objects[0].body, scene.objects[1].body);
    EXPECT_TRUE(scene.materials[0].refractive());
    EXPECT_EQ(warnings_with(scene, "not a closed solid"), 0u);

    const Scene pane =
        load_scene(folder_.file("b.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl a\nf 1 2 3 4\n"));
    EXPECT_TRUE(pane.materials[0].transmissive() && !pane.materials[0].refractive());
    EXPECT_EQ(warnings_with(pane, "a: an open surface, drawn as thin glass that does not bend light"), 1u);
    EXPECT_EQ(warnings_with(pane, "not a closed solid"), 0u);
}

TEST_F(ObjMaterials, ColoursOfVertices) {
    folder_.file("a.mtl", "newmtl a\nKd 1 1 1\n");
    std::string text = "mtllib a.mtl\nusemtl a\nv 0 0 0 1 0 0.5\nv 1 0 0\nv 0 1 0 0 1 0\nf 1 2 3\n";
    const Scene scene = load_scene(folder_.file("a.obj", text));
    ASSERT_EQ(scene.meshes.at(0).colors.size(), 3u);
    EXPECT_NEAR(scene.meshes[0].colors[0].b, 0.2140411f, 1e-5f) << "stored for display";
    EXPECT_EQ(scene.meshes[0].colors[1], glm::vec4(1.0f));
}

TEST_F(ObjMaterials, ColoursOfVerticesAreBytesInTheWholeFile) {
    folder_.file("a.mtl", "newmtl a\nKd 1 1 1\n");
    const std::string text = "mtllib a.mtl\nusemtl a\nv 0 0 0 1 0 1\nv 1 0 0 255 128 0\nv 0 1 0\nf 1 2 3\n";
    const Scene scene = load_scene(folder_.file("a.obj", text));
    ASSERT_EQ(scene.meshes.at(0).colors.size(), 3u);
    EXPECT_NEAR(scene.meshes[0].colors[0].r, 1.0f / 255.0f / 12.92f, 1e-6f);
    EXPECT_NEAR(scene.meshes[0].colors[1].g, 0.2158605f, 1e-5f);
    EXPECT_EQ(scene.meshes[0].colors[2], glm::vec4(1.0f));
}

TEST_F(ObjMaterials, ReportedScene) {
    const std::filesystem::path file = test::data_folder() / "reports/21-scene.obj";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "PELLUCID_TEST_DATA names no folder with reports/21-scene.obj";
    const Scene scene = load_scene(file.string());
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    ASSERT_EQ(scene.objects.size(), 3u);
    EXPECT_EQ(scene.materials[std::size_t(scene.objects[1].material)].ior, 1.33f);
    EXPECT_FALSE(scene.materials[std::size_t(scene.objects[0].material)].transmissive());
    EXPECT_FALSE(scene.materials[std::size_t(scene.objects[2].material)].transmissive());
}

}  // namespace
}  // namespace pellucid
