// Every glTF extension is treated as the table of the loader says, and docs/gltf.md says the same.
#include "gltf_builder.h"
#include "test_files.h"
#include "test_meshes.h"

#include <pellucid/animation.h>
#include <pellucid/gltf_extensions.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

using namespace test;

TEST(GltfExtensions, AreTreatedAsTheTableSays) {
    std::string_view before;
    for (const GltfExtension& extension : gltf_extensions()) {
        SCOPED_TRACE(extension.name);
        EXPECT_LT(before, extension.name) << "ordered by name";
        before = extension.name;
        const TemporaryFolder folder;
        GltfBuilder b = GltfBuilder::triangle();
        const bool left_out = extension.support == GltfSupport::kIgnored || extension.support == GltfSupport::kRefused;
        b.root["extensionsUsed"] = {std::string(extension.name)};
        const Scene scene = load_scene(b.gltf(folder));
        EXPECT_EQ(scene.warnings.size(), left_out ? 1u : 0u);
        EXPECT_EQ(warnings_with(scene, "a.gltf: glTF extension " + std::string(extension.name) + " is ignored"),
                  left_out ? 1u : 0u);
        b.root["extensionsRequired"] = {std::string(extension.name)};
        const std::string error = load_error(b.gltf(folder));
        EXPECT_EQ(!error.empty(), extension.support == GltfSupport::kRefused) << error;
    }
}

TEST(GltfExtensions, UnknownOnesAreRefusedWhereTheyAreRequired) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    b.root["extensionsUsed"] = {"XYZ_holograms"};
    EXPECT_EQ(warnings_with(load_scene(b.gltf(folder)), "glTF extension XYZ_holograms is ignored"), 1u);
    b.root["extensionsRequired"] = {"XYZ_holograms"};
    const std::string file = b.gltf(folder);
    EXPECT_EQ(load_error(file), file +
                                    ": requires glTF extension XYZ_holograms, which is not supported: export the "
                                    "file without it");
}

TEST(GltfExtensions, ThePageHasTheTable) {
    std::string table = "| extension | how it is drawn | |\n|---|---|---|\n";
    for (const GltfExtension& extension : gltf_extensions())
        table += "| " + std::string(extension.name) + " | " + std::string(support_name(extension.support)) + " | " +
                 std::string(extension.how) + " |\n";
    EXPECT_NE(content_of(PELLUCID_DOCS_FOLDER "/gltf.md").find(table), std::string::npos)
        << "docs/gltf.md should have this table:\n\n"
        << table;
}

// --- EXT_mesh_gpu_instancing ------------------------------------------------------------------------

/// The triangle's node with three instances: moved, turned about z by 90 degrees, scaled by 2.
GltfBuilder instances() {
    GltfBuilder b = GltfBuilder::triangle();
    const float h = float(std::sqrt(0.5));
    const int translation = b.attribute<float>({5, 0, 0, 0, 0, 0, 0, 0, 0}, kFloat, "VEC3", 3);
    const int rotation = b.attribute<float>({0, 0, 0, 1, 0, 0, h, h, 0, 0, 0, 1}, kFloat, "VEC4", 4);
    const int scale = b.attribute<float>({1, 1, 1, 1, 1, 1, 2, 2, 2}, kFloat, "VEC3", 3);
    b.root["nodes"][0]["translation"] = {0, 100, 0};
    b.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}, {"_TINT", translation}};
    b.root["extensionsUsed"] = b.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    return b;
}

TEST(GltfInstances, StandWhereTheirTransformsSay) {
    const TemporaryFolder folder;
    const Scene scene = load_scene(instances().gltf(folder));
    EXPECT_EQ(broken_promise(scene), "");
    EXPECT_EQ(scene.warnings, std::vector<std::string>{"thing: attributes of its instances left out: _TINT"});
    EXPECT_EQ(scene.meshes.size(), 1u);
    ASSERT_EQ(scene.objects.size(), 3u);
    const glm::vec3 expected[] = {{6, 100, 0}, {0, 101, 0}, {2, 100, 0}};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec3 p = scene.objects[i].world_from_object * glm::vec4(1, 0, 0, 1);
        EXPECT_LT(glm::length(p + glm::vec3(scene.origin) - expected[i]), 1e-4f) << i << ": " << p.x << " " << p.y;
    }
}

TEST(GltfInstances, MoveWithTheirNode) {
    const TemporaryFolder folder;
    GltfBuilder b = instances();
    const int times = b.attribute<float>({0, 1}, kFloat, "SCALAR", 1);
    const int places = b.attribute<float>({0, 0, 0, 0, 0, 10}, kFloat, "VEC3", 3);
    b.root["animations"] = {{{"samplers", {{{"input", times}, {"output", places}}}},
                             {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    const Scene scene = load_scene(b.gltf(folder));
    const Pose pose = pose_at(scene, 0, 0.5);
    ASSERT_EQ(pose.objects.size(), 3u);
    const glm::vec3 p = pose.objects[2].world_from_object * glm::vec4(1, 0, 0, 1);
    EXPECT_LT(glm::length(p + glm::vec3(scene.origin) - glm::vec3(2, 0, 5)), 1e-4f);
}

TEST(GltfInstances, OddOnesAreRefusedOrDrawnOnce) {
    const TemporaryFolder folder;
    GltfBuilder b = instances();
    json& attributes = b.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes["TRANSLATION"] = b.attribute<float>({5, 0, 0}, kFloat, "VEC3", 3);
    EXPECT_NE(load_error(b.gltf(folder)).find("thing: its instances have 1 translations, 3 rotations"),
              std::string::npos);
    attributes = {{"_TINT", 0}};
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(warnings_with(scene, "thing: its instances have no transforms"), 1u);
    attributes = {{"TRANSLATION", 99}};
    EXPECT_NE(load_error(b.gltf(folder)).find("there is no accessor 99"), std::string::npos);
    attributes = {{"TRANSLATION", 1e300}};
    EXPECT_NE(load_error(b.gltf(folder)).find("there is no accessor 2147483647"), std::string::npos);
}

TEST(GltfInstances, AreNotMadeOfNothing) {
    const TemporaryFolder folder;
    GltfBuilder b = instances();
    const int accessor =
        b.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"].get<int>();
    json& translation = b.root["accessors"][std::size_t(accessor)];
    const json given = translation;
    translation.erase("bufferView");
    EXPECT_NE(load_error(b.gltf(folder)).find("thing: accessor 1 of its instances has no data"), std::string::npos);
    translation = given;
    translation["count"] = (1 << 20) + 1;
    EXPECT_NE(load_error(b.gltf(folder)).find("thing: its 1048577 instances make more than 1048576 in the scene"),
              std::string::npos);
}

// --- KHR_node_visibility, KHR_animation_pointer -------------------------------------------------------

TEST(GltfExtensions, HiddenNodesHideWhatIsBelowThem) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    b.root["scenes"][0]["nodes"] = {0, 1};
    b.node({{"children", {2}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
    b.node({{"mesh", 0}, {"name", "below"}});
    const Scene scene = load_scene(b.gltf(folder));
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.objects[0].name, "thing");
}

TEST(GltfExtensions, PointersAnimateNodesAndNothingElse) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    const int times = b.attribute<float>({0, 1}, kFloat, "SCALAR", 1);
    const int places = b.attribute<float>({0, 0, 0, 0, 0, 10}, kFloat, "VEC3", 3);
    const auto channel = [](const char* pointer) {
        return json{
            {"sampler", 0},
            {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}};
    };
    b.root["animations"] = {{{"samplers", {{{"input", times}, {"output", places}}}},
                             {"channels", {channel("/nodes/0/translation"), channel("/materials/0/emissiveFactor")}}}};
    LoadOptions late;
    late.time_s = 1.0;
    const Scene scene = load_scene(b.gltf(folder), late);
    EXPECT_EQ((scene.objects.at(0).world_from_object * glm::vec4(0, 0, 0, 1)).z + float(scene.origin.z), 10.0f);
    EXPECT_EQ(warnings_with(scene, "1 animation channel of materials, lights or cameras left out"), 1u);
}

// --- solid glass --------------------------------------------------------------------------------------

/// A cube of glass without a volume, and an open sheet of the same glass.
GltfBuilder cube_without_volume() {
    GltfBuilder b;
    const Mesh mesh = cube();
    std::vector<float> positions;
    std::vector<std::uint16_t> indices;
    for (const glm::vec3 p : mesh.positions) positions.insert(positions.end(), {p.x, p.y, p.z});
    for (const glm::uvec3 t : mesh.triangles)
        indices.insert(indices.end(), {std::uint16_t(t.x), std::uint16_t(t.y), std::uint16_t(t.z)});
    const int position = b.attribute(positions, kFloat, "VEC3", 3);
    b.mesh({{"POSITION", position}}, {{"indices", b.attribute(indices, kUnsignedShort, "SCALAR", 1)}, {"material", 0}});
    indices.resize(6);
    b.mesh({{"POSITION", position}}, {{"indices", b.attribute(indices, kUnsignedShort, "SCALAR", 1)}, {"material", 0}});
    b.node({{"mesh", 0}, {"name", "cube"}});
    b.node({{"mesh", 1}, {"name", "sheet"}});
    b.root["scenes"][0]["nodes"] = {0, 1};
    b.root["materials"] = {{{"name", "window"},
                            {"alphaMode", "BLEND"},
                            {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}},
                            {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}}};
    return b;
}

TEST(SolidGlass, ClosedMeshesWithoutAVolumeGiveAHint) {
    const TemporaryFolder folder;
    const Scene scene = load_scene(cube_without_volume().gltf(folder));
    EXPECT_EQ(warnings_with(scene, "--solid"), 1u);
    EXPECT_EQ(warnings_with(scene, "material window: without a volume"), 1u);
    for (const Object& object : scene.objects) EXPECT_FALSE(scene.materials[std::size_t(object.material)].refractive());
}

TEST(SolidGlass, OneHintNamesAFewOfManyMaterials) {
    const TemporaryFolder folder;
    GltfBuilder b = cube_without_volume();
    for (int i = 1; i < 6; ++i) {
        b.root["materials"].push_back(b.root["materials"][0]);
        b.root["materials"][std::size_t(i)]["name"] = "pane " + std::to_string(i);
        json mesh = b.root["meshes"][0];
        mesh["primitives"][0]["material"] = i;
        b.root["meshes"].push_back(mesh);
        b.root["nodes"][0]["children"].push_back(b.root["nodes"].size());
        b.root["nodes"].push_back({{"mesh", b.root["meshes"].size() - 1}});
    }
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_EQ(warnings_with(scene, "--solid"), 1u);
    EXPECT_EQ(warnings_with(scene, "materials window, pane 1, pane 2, pane 3 and 2 more: without a volume"), 1u);
}

TEST(SolidGlass, TheOptionMakesClosedMeshesSolidAndOpenOnesStayThin) {
    const TemporaryFolder folder;
    LoadOptions solid;
    solid.solid = true;
    solid.ior = 1.7f;
    const Scene scene = load_scene(cube_without_volume().gltf(folder), solid);
    EXPECT_EQ(broken_promise(scene), "");
    EXPECT_EQ(warnings_with(scene, "--solid"), 0u);
    EXPECT_EQ(warnings_with(scene, "material window: alpha is left out"), 1u);
    ASSERT_EQ(scene.objects.size(), 2u);
    const Material& glass = scene.materials[std::size_t(scene.objects[0].material)];
    EXPECT_TRUE(glass.refractive());
    EXPECT_EQ(glass.ior, 1.7f);
    EXPECT_FALSE(glass.alpha_is_coverage);
    EXPECT_FALSE(scene.materials[std::size_t(scene.objects[1].material)].refractive()) << "a sheet bounds nothing";
}

TEST(SolidGlass, UnitsThatCannotBeMetresGiveAHint) {
    const auto hints = [](double distance, double scale) {
        const TemporaryFolder folder;
        GltfBuilder b = cube_without_volume();
        b.root["nodes"][0]["scale"] = {scale, scale, scale};
        b.root["scenes"][0]["nodes"] = {0};
        b.root["materials"][0]["extensions"]["KHR_materials_volume"] = {
            {"thicknessFactor", 1}, {"attenuationDistance", distance}, {"attenuationColor", {0.5, 1, 1}}};
        return warnings_with(load_scene(b.gltf(folder)), "is the file in metres?");
    };
    EXPECT_EQ(hints(1.0, 1.0), 0u);
    EXPECT_EQ(hints(1.0, 900.0), 0u);
    EXPECT_EQ(hints(1.0, 1100.0), 1u);
    EXPECT_EQ(hints(1.0, 0.0009), 1u);
}

}  // namespace
}  // namespace pellucid
