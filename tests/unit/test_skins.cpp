// Skins and morph targets of glTF files against answers known from paper.
#include "animated_gltf.h"
#include "core/math.h"
#include "test_files.h"
#include "test_meshes.h"

#include <pellucid/animation.h>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace pellucid {
namespace {

using namespace test;

/// Where the hinged bar's vertices are once joint 2 has turned by an angle about z.
std::vector<glm::vec3> bent_bar(float angle) {
    std::vector<glm::vec3> positions;
    for (const float x : {-0.1f, 0.1f}) positions.emplace_back(x, 0, 0);
    const float c = std::cos(angle), s = std::sin(angle);
    for (const float x : {-0.1f, 0.1f})
        positions.push_back(0.5f * (glm::vec3(x, 1, 0) + glm::vec3(c * x, 1 + s * x, 0)));
    for (const float x : {-0.1f, 0.1f}) positions.emplace_back(c * x - s, 1 + s * x + c, 0);
    return positions;
}

void expect_bar(const std::vector<glm::vec3>& positions, float angle) {
    const std::vector<glm::vec3> expected = bent_bar(angle);
    ASSERT_EQ(positions.size(), expected.size());
    for (std::size_t v = 0; v < expected.size(); ++v)
        expect_near(positions[v], expected[v], "vertex " + std::to_string(v));
}

// --- skins ------------------------------------------------------------------------------------------

TEST(Skins, BarBendsAtItsHinge) {
    GltfBuilder b = hinged_bar();
    const Scene scene = load(b);
    EXPECT_EQ(broken_promise(scene), "");
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(scene.objects.at(0).world_from_object, glm::mat4(1.0f)) << "the node's own transform does not count";
    expect_bar(scene.meshes.at(0).positions, 0.0f);

    for (const auto& [time_s, angle] :
         {std::pair{0.0, 0.0f}, {1.0, 0.0f}, {2.0, kPi / 4}, {3.0, kPi / 2}, {9.0, kPi / 2}}) {
        SCOPED_TRACE(time_s);
        const Pose pose = pose_at(scene, 0, time_s);
        ASSERT_EQ(pose.meshes.size(), 1u);
        expect_bar(pose.meshes[0].positions, angle);
        expect_near(pose.meshes[0].normals[0], {1, 0, 0}, "normal of joint 1");
        expect_near(pose.meshes[0].normals[5], {std::cos(angle), std::sin(angle), 0}, "normal of joint 2");
        const Scene posed = load(b, at(time_s));
        EXPECT_EQ(posed.meshes[0].positions, pose.meshes[0].positions) << "loading gives the same pose";
        EXPECT_EQ(posed.meshes[0].normals, pose.meshes[0].normals);
        EXPECT_EQ(broken_promise(posed), "");
    }
}

TEST(Skins, RestIsTheNodesOwn) {
    GltfBuilder b = hinged_bar();
    b.root["nodes"][2]["rotation"] = {0, 0, kHalfRoot, kHalfRoot};
    expect_bar(load(b).meshes.at(0).positions, kPi / 2);
    b.root.erase("animations");
    const Scene still = load(b);
    expect_bar(still.meshes.at(0).positions, kPi / 2);
    EXPECT_TRUE(animations(still).empty());
    EXPECT_EQ(still.rig, nullptr);
}

TEST(Skins, JointsFollowTheirAncestorsAlsoOutsideTheScene) {
    GltfBuilder b = hinged_bar();
    b.node({{"children", {1}}, {"translation", {5, 0, 0}}, {"scale", {2, 2, 2}}});
    b.root["scenes"][0]["nodes"] = {0};  // node 3 stands in no scene
    const Scene scene = load(b);
    expect_near(scene.meshes.at(0).positions[5], {5.2f, 4, 0});
    expect_near(pose_at(scene, 0, 3).meshes.at(0).positions[5], {3, 2.2f, 0});
}

TEST(Skins, MissingInverseBindMatricesAreIdentities) {
    GltfBuilder b = hinged_bar();
    b.root["skins"][0].erase("inverseBindMatrices");
    const Scene scene = load(b);
    EXPECT_TRUE(scene.warnings.empty());
    expect_near(scene.meshes.at(0).positions[4], {-0.1f, 3, 0}, "lifted by joint 2");
}

TEST(Skins, EverySetOfJointsCountsInAnyFormat) {
    GltfBuilder b = hinged_bar();
    // Half of each vertex's weight in the second set, in 16 bits: all vertices half and half.
    json& attributes = b.root["meshes"][0]["primitives"][0]["attributes"];
    const std::vector<std::uint16_t> first(24, 0);
    std::vector<std::uint16_t> second(24, 0), halves(24, 0);
    for (std::size_t v = 0; v < 6; ++v) second[4 * v + 2] = 1, halves[4 * v + 2] = 65535;
    attributes["JOINTS_0"] = b.attribute(first, kUnsignedShort, "VEC4", 4);
    attributes["JOINTS_1"] = b.attribute(second, kUnsignedShort, "VEC4", 4);
    const int half = b.accessor(b.view(halves), kUnsignedShort, "VEC4", 6, {{"normalized", true}});
    std::vector<std::uint8_t> ones(24, 0);
    for (std::size_t v = 0; v < 6; ++v) ones[4 * v + 3] = 255;
    attributes["WEIGHTS_0"] = b.accessor(b.view(ones), kUnsignedByte, "VEC4", 6, {{"normalized", true}});
    attributes["WEIGHTS_1"] = half;
    const Scene scene = load(b, at(3));
    EXPECT_EQ(warnings_with(scene, "joint weights of 6 vertices do not add to 1"), 1u) << "they add to 2";
    const glm::vec3 still(0.1f, 2, 0), turned(-1, 1.1f, 0);
    expect_near(scene.meshes.at(0).positions[5], 0.5f * (still + turned));
}

TEST(Skins, OddWeightsAreRepairedAndCounted) {
    GltfBuilder b = hinged_bar();
    b.root["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = b.attribute<float>(
        {1, 0, 0, 0, 0.2f, 0, 0, 0, 2, 2, 0, 0, 0.5f, 0.5f, 0, 0, 0, 0, 0, 0, 1, -1, 0, 0}, kFloat, "VEC4", 4);
    const Scene scene = load(b, at(3));
    EXPECT_EQ(warnings_with(scene, "joint weights of 3 vertices do not add to 1"), 1u);
    EXPECT_EQ(warnings_with(scene, "1 vertex has no joint weights"), 1u);
    expect_bar(scene.meshes.at(0).positions, kPi / 2);
}

TEST(Skins, MirroringSkinsTurnTheWinding) {
    GltfBuilder b = hinged_bar();
    b.root["nodes"][1]["scale"] = {-1, 1, 1};
    json& attributes = b.root["meshes"][0]["primitives"][0]["attributes"];
    for (const bool made : {false, true}) {
        if (made)
            attributes.erase("NORMAL");
        else
            attributes["NORMAL"] =
                b.attribute<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 3);
        const Scene scene = load(b);
        for (const glm::uvec3 t : scene.meshes.at(0).triangles) expect_near(face_normal(scene.meshes[0], t), {0, 0, 1});
        for (const glm::vec3 n : scene.meshes[0].normals) expect_near(n, {0, 0, 1});
        const Pose pose = pose_at(scene, 0, 3);
        for (const glm::vec3 n : pose.meshes.at(0).normals) expect_near(n, {0, 0, 1});
    }
}

TEST(Skins, MeshesShownTwiceDeformApart) {
    GltfBuilder b = hinged_bar();
    b.root["skins"].push_back({{"joints", {4, 5}}, {"inverseBindMatrices", b.root["skins"][0]["inverseBindMatrices"]}});
    b.node({{"mesh", 0}, {"skin", 1}, {"name", "second"}});
    b.node({{"children", {5}}, {"translation", {7, 0, 0}}});
    b.node({{"translation", {0, 1, 0}}});
    b.root["scenes"][0]["nodes"] = {0, 1, 3, 4};
    const Scene scene = load(b);
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.objects.at(1).mesh, 1);
    expect_near(scene.meshes[1].positions[0], {6.9f, 0, 0});
    const Pose pose = pose_at(scene, 0, 3);
    ASSERT_EQ(pose.meshes.size(), 1u) << "nothing moves the second skin";
    EXPECT_EQ(animations(scene).at(0).meshes, std::vector<int>{0});
}

// --- morph targets ----------------------------------------------------------------------------------

TEST(Morphs, HalfAWeightIsHalfWay) {
    GltfBuilder b = morphed_triangle();
    const Scene scene = load(b);
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(scene.meshes.at(0).positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    const Pose pose = pose_at(scene, 0, 1.0);
    EXPECT_EQ(pose.meshes.at(0).positions, (std::vector<glm::vec3>{{0, 0, 1}, {2, 0, 0}, {0, 1, 0}}));
    expect_near(pose.meshes[0].normals[0], glm::normalize(glm::vec3(0.5f, 0, 0.5f)));
    expect_near(pose.meshes[0].normals[1], {0, 0, 1});
    expect_near(pose_at(scene, 0, 77).meshes.at(0).normals[0], {1, 0, 0}, "the end stays");
    EXPECT_EQ(load(b, at(1)).meshes.at(0).positions, pose.meshes[0].positions);
    const std::vector<MovedMesh> moved = pose.moved_meshes();
    ASSERT_EQ(moved.size(), 1u);
    EXPECT_EQ(moved[0].positions.data(), pose.meshes[0].positions.data());
}

TEST(Morphs, DefaultWeightsAreTheNodesElseTheMeshs) {
    GltfBuilder b = morphed_triangle();
    b.root["meshes"][0]["weights"] = {0.25, 0};
    b.node({{"mesh", 0}, {"weights", {0, 0.5}}, {"translation", {9, 0, 0}}});
    b.node({{"mesh", 0}, {"weights", {0, 0.5}}});
    b.root["scenes"][0]["nodes"] = {0, 1, 2};
    const Scene scene = load(b);
    ASSERT_EQ(scene.meshes.size(), 2u) << "those of equal weights that nothing drives share one";
    EXPECT_EQ(scene.objects.at(1).mesh, scene.objects.at(2).mesh);
    EXPECT_EQ(scene.meshes[0].positions[0], glm::vec3(0, 0, 0.5f));
    EXPECT_EQ(scene.meshes[1].positions[1], glm::vec3(3, 0, 0));
    EXPECT_EQ(scene.objects[1].world_from_object[3], glm::vec4(9, 0, 0, 1))
        << "without a skin the node's transform holds";
    EXPECT_EQ(animations(scene).at(0).meshes, std::vector<int>{0});

    b.root["meshes"][0]["weights"] = {0.25};
    EXPECT_EQ(warnings_with(load(b), "1 weights for 2 morph targets"), 1u);
}

TEST(Morphs, MadeNormalsFollowTheTriangles) {
    for (const bool smooth : {false, true}) {
        GltfBuilder b = morphed_triangle();
        LoadOptions options;
        options.remake_normals = smooth;
        if (!smooth) b.root["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
        const Scene scene = load(b, options);
        Mesh mesh = scene.meshes.at(0);
        const Pose pose = pose_at(scene, 0, 2);
        mesh.positions = pose.meshes.at(0).positions;
        for (const glm::vec3 n : pose.meshes[0].normals) expect_near(n, face_normal(mesh, mesh.triangles[0]));
    }
}

TEST(Morphs, GlassThatIsTurnedIsTurnedInEveryPose) {
    GltfBuilder b;
    const Mesh solid = cube();
    std::vector<float> positions, inward, taller(24, 0.0f), tilted(24, 0.0f);
    std::vector<std::uint16_t> indices;
    for (std::size_t v = 0; v < 8; ++v) {
        for (int k = 0; k < 3; ++k)
            positions.push_back(solid.positions[v][k]), inward.push_back(-solid.positions[v][k]);
        taller[3 * v + 1] = solid.positions[v].y;
        tilted[3 * v + 1] = solid.positions[v].y / 2;  // the normals of a taller one lie flatter
    }
    for (const glm::uvec3 t : solid.triangles)
        indices.insert(indices.end(), {std::uint16_t(t.x), std::uint16_t(t.z), std::uint16_t(t.y)});
    json more = {{"material", 0}};
    more["indices"] = b.attribute(indices, kUnsignedShort, "SCALAR", 1);
    more["targets"] = {
        {{"POSITION", b.attribute(taller, kFloat, "VEC3", 3)}, {"NORMAL", b.attribute(tilted, kFloat, "VEC3", 3)}}};
    b.mesh(
        {{"POSITION", b.attribute(positions, kFloat, "VEC3", 3)}, {"NORMAL", b.attribute(inward, kFloat, "VEC3", 3)}},
        more);
    b.root["materials"] = {{{"extensions",
                             {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                              {"KHR_materials_volume", {{"thicknessFactor", 1}}}}}}};
    b.node({{"mesh", 0}});
    add_channel(b, 0, "weights", {0, 1}, {0, 1}, "SCALAR", 1);
    const Scene scene = load(b);
    EXPECT_EQ(warnings_with(scene, "was wound inside out, turned"), 1u);
    Mesh mesh = scene.meshes.at(0);
    for (const double time_s : {0.0, 1.0}) {
        const Pose pose = pose_at(scene, 0, time_s);
        mesh.positions = pose.meshes.at(0).positions;
        for (const glm::uvec3 t : mesh.triangles) EXPECT_GT(glm::dot(face_normal(mesh, t), mesh.positions[t.x]), 0.0f);
        for (std::size_t v = 0; v < 8; ++v) {
            // The file's: unit inward normals, displaced by a quarter of a unit along y, then turned outward.
            const glm::vec3 p = solid.positions[mesh.positions[v].y > 0 ? 7 : 0];
            const float y = 1 / std::sqrt(3.0f) - float(time_s) * 0.25f;
            const glm::vec3 n = pose.meshes[0].normals[v];
            EXPECT_NEAR(n.y * (p.y > 0 ? 1.0f : -1.0f), y / std::sqrt(2.0f / 3.0f + y * y), kCloseTo) << time_s;
        }
    }
}

}  // namespace
}  // namespace pellucid
