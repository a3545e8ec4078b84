// Keyframes and animations of glTF files against answers known from paper.
#include "animated_gltf.h"
#include "core/math.h"
#include "test_files.h"
#include "test_meshes.h"

#include <pellucid/animation.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace pellucid {
namespace {

using namespace test;
using testing::HasSubstr;

/// Where a rigid node's origin and x axis are in a pose.
glm::mat4 placement(const Scene& scene, double time_s, std::size_t animation = 0) {
    return pose_at(scene, animation, time_s).objects.at(0).world_from_object;
}

TEST(Keyframes, HalfOfAQuarterTurnIs45Degrees) {
    GltfBuilder b = GltfBuilder::triangle();
    // The second key is the same rotation with the opposite sign: the shorter arc counts.
    add_channel(b, 0, "rotation", {0, 1, 2}, {0, 0, 0, 1, 0, 0, -kHalfRoot, -kHalfRoot, 0, 0, 1, 0}, "VEC4", 4);
    const Scene scene = load(b);
    for (const double time_s : {0.0, 0.25, 0.5, 1.0, 1.5, 2.0}) {
        const float angle = float(time_s) * kPi / 2;
        expect_near(placement(scene, time_s)[0], {std::cos(angle), std::sin(angle), 0}, std::to_string(time_s));
        expect_near(load(b, at(time_s)).objects.at(0).world_from_object[0], {std::cos(angle), std::sin(angle), 0});
    }
    const AnimationInfo info = animations(scene).at(0);
    EXPECT_EQ(info.name, "animation 0");
    EXPECT_EQ(info.duration_s, 2.0);
    EXPECT_EQ(info.objects, std::vector<int>{0});
    EXPECT_TRUE(info.meshes.empty());
}

TEST(Keyframes, StepLinearAndTheEnds) {
    GltfBuilder b = GltfBuilder::triangle();
    b.root["nodes"][0]["scale"] = {3, 3, 3};
    add_channel(b, 0, "translation", {1, 2, 4}, {0, 0, 0, 1, 2, 3, 5, 2, 3}, "VEC3", 3);
    add_channel(b, 0, "scale", {1, 2}, {1, 1, 1, 2, 2, 2}, "VEC3", 3, "STEP");
    const Scene scene = load(b);
    EXPECT_EQ(scene.objects.at(0).world_from_object[0].x, 3.0f) << "at rest";
    EXPECT_EQ(glm::vec3(placement(scene, 0)[3]), glm::vec3(0, 0, 0));
    EXPECT_EQ(glm::vec3(placement(scene, 1.5)[3]), glm::vec3(0.5f, 1, 1.5f));
    EXPECT_EQ(glm::vec3(placement(scene, 3)[3]), glm::vec3(3, 2, 3));
    EXPECT_EQ(glm::vec3(placement(scene, 100)[3]), glm::vec3(5, 2, 3));
    EXPECT_EQ(placement(scene, 1.99)[0].x, 1.0f);
    EXPECT_EQ(placement(scene, 2)[0].x, 2.0f);
}

TEST(Keyframes, CubicSplinesFollowTheirFormula) {
    GltfBuilder b = GltfBuilder::triangle();
    const glm::vec3 p0(1, 2, 3), m0(4, -5, 6), m1(-7, 8, 9), p1(2, 1, 0);
    std::vector<float> values;
    for (const glm::vec3& v : {glm::vec3(99), p0, m0, m1, p1, glm::vec3(99)})
        values.insert(values.end(), {v.x, v.y, v.z});
    add_channel(b, 0, "translation", {1, 3}, values, "VEC3", 3, "CUBICSPLINE");
    const float h = kHalfRoot;
    add_channel(b, 0, "rotation", {1, 3}, {9, 9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, h, h, 9, 9, 9, 9},
                "VEC4", 4, "CUBICSPLINE");
    const Scene scene = load(b);
    for (const float time_s : {1.0f, 1.5f, 2.0f, 2.75f, 3.0f}) {
        const float d = 2, t = (time_s - 1) / d;
        const glm::vec3 expected = (2 * t * t * t - 3 * t * t + 1) * p0 + d * (t * t * t - 2 * t * t + t) * m0 +
                                   (-2 * t * t * t + 3 * t * t) * p1 + d * (t * t * t - t * t) * m1;
        expect_near(placement(scene, time_s)[3], expected, std::to_string(time_s));
    }
    EXPECT_EQ(glm::vec3(placement(scene, 0)[3]), p0);
    EXPECT_EQ(glm::vec3(placement(scene, 9)[3]), p1);
    // Without tangents half way is the mean of the quaternions: half the angle.
    expect_near(placement(scene, 2)[0], {h, h, 0});
}

TEST(Keyframes, RotationsAndWeightsMayBeNormalizedIntegers) {
    GltfBuilder b = morphed_triangle();
    json& samplers = b.root["animations"][0]["samplers"];
    samplers[0]["output"] =
        b.accessor(b.view<std::uint8_t>({0, 0, 255, 51}), kUnsignedByte, "SCALAR", 4, {{"normalized", true}});
    add_channel(b, 0, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, 0, 1}, "VEC4", 4);
    samplers[1]["output"] = b.accessor(b.view<std::int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170}), kShort, "VEC4", 2,
                                       {{"normalized", true}});
    const Scene scene = load(b);
    const Pose pose = pose_at(scene, 0, 2);
    EXPECT_EQ(pose.meshes.at(0).positions, (std::vector<glm::vec3>{{0, 0, 2}, {1 + 4 * 0.2f, 0, 0}, {0, 1, 0}}));
    expect_near(pose.objects.at(0).world_from_object[0], {0, 1, 0});
}

TEST(Animations, MoveWhatHangsOnTheNodeCamerasAndLightsToo) {
    GltfBuilder b = GltfBuilder::triangle();
    b.root["nodes"] = {
        {{"children", {1, 2}}}, {{"mesh", 0}, {"translation", {1, 0, 0}}}, {{"camera", 0}, {"name", "eye"}}};
    b.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
    add_channel(b, 0, "translation", {0, 1}, {0, 0, 0, 0, 5, 0}, "VEC3", 3);
    const Scene scene = load(b, at(1));
    EXPECT_EQ(glm::vec3(scene.objects.at(0).world_from_object[3]), glm::vec3(1, 5, 0));
    EXPECT_EQ(glm::vec3(scene.cameras.at(0).world_from_view[3]), glm::vec3(0, 5, 0));
}

TEST(Animations, PosesDoNotDependOnTheOneBefore) {
    GltfBuilder b = morphed_triangle();
    b.node({{"mesh", 0}, {"translation", {3, 0, 0}}});
    b.root["scenes"][0]["nodes"] = {0, 1};
    add_channel(b, 1, "weights", {0, 1}, {0, 0, 1, 1}, "SCALAR", 1, "LINEAR", 1);
    b.root["animations"][1]["name"] = "other";
    const Scene scene = load(b, at(2));
    const Pose pose = pose_at(scene, find_animation(scene, "other"), 1);
    ASSERT_EQ(pose.meshes.size(), 2u);
    EXPECT_EQ(pose.meshes[0].positions[0], glm::vec3(0, 0, 0)) << "what only the first moves is at rest";
    EXPECT_EQ(pose.meshes[1].positions[0], glm::vec3(0, 0, 2));
    EXPECT_EQ(animations(scene).at(1).meshes, std::vector<int>{1});
}

TEST(Animations, AreFoundByNameOrNumber) {
    GltfBuilder b = morphed_triangle();
    add_channel(b, 0, "translation", {0}, {0, 0, 1}, "VEC3", 3, "LINEAR", 1);
    b.root["animations"][1]["name"] = "0";
    LoadOptions options;
    options.animation = "0";
    const Scene named = load(b, options);
    EXPECT_EQ(named.objects.at(0).world_from_object[3].z, 1.0f) << "names come first";
    EXPECT_EQ(find_animation(named, "grow"), 0u);
    EXPECT_EQ(find_animation(named, "1"), 1u);
    options.animation = "walk";
    EXPECT_THAT(error_of(b, options), HasSubstr("unknown animation 'walk'; known: grow, 0"));
    options.animation = "2";
    EXPECT_THAT(error_of(b, options), HasSubstr("unknown animation '2'; known: grow, 0"));
    EXPECT_THROW(pose_at(named, 2, 0), Error);

    b.root.erase("animations");
    EXPECT_THAT(error_of(b, options), HasSubstr("has no animations"));
    EXPECT_THAT(error_of(b, at(0)), HasSubstr("has no animations"));
    EXPECT_EQ(load_error("shape:cube", at(0)), "shape:cube: has no animations");
    EXPECT_THROW(pose_at(load_scene("shape:cube"), 0, 0), Error);
}

TEST(Animations, TimesBeforeTheStartAreRefused) {
    GltfBuilder b = morphed_triangle();
    const Scene scene = load(b);
    for (const double time_s : {-1e-9, -1.0, double(INFINITY), double(NAN)}) {
        EXPECT_THAT(error_of(b, at(time_s)), HasSubstr("must be a number from 0"));
        EXPECT_THROW(pose_at(scene, 0, time_s), Error);
    }
    EXPECT_NO_THROW(pose_at(scene, 0, std::numeric_limits<double>::max()));
}

TEST(Animations, SceneMayGrowButNotChange) {
    GltfBuilder b = morphed_triangle();
    Scene scene = load(b);
    scene.meshes.push_back(cube());
    EXPECT_NO_THROW(pose_at(scene, 0, 1));
    scene.meshes.erase(scene.meshes.begin());
    EXPECT_THROW(pose_at(scene, 0, 1), Error);
}

TEST(RealAnimations, MorphCube) {
    const std::filesystem::path file = data_folder() / "gltf/AnimatedMorphCube/glTF-Binary/AnimatedMorphCube.glb";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "PELLUCID_TEST_DATA names no folder with AnimatedMorphCube";
    const Scene scene = load_scene(file.string());
    EXPECT_TRUE(scene.warnings.empty());
    const AnimationInfo info = animations(scene).at(0);
    EXPECT_EQ(info.name, "Square");
    EXPECT_NEAR(info.duration_s, 4.2, 1e-5);
    EXPECT_EQ(info.meshes, std::vector<int>{0});
    // Worked out from the file's numbers: weights of both targets, which move vertices along y alone.
    struct Known {
        double time_s;
        float lowest, sum;  ///< of y over the 24 vertices
    };
    for (const Known& known : {Known{0.0, -0.01f, 0.0f}, Known{1.0, 0.00294215f, 0.1553059f},
                               Known{2.05, 0.00448038f, 0.2018296f}, Known{3.3, -0.00982961f, 0.1203156f}}) {
        const Pose pose = pose_at(scene, 0, known.time_s);
        const std::vector<glm::vec3>& positions = pose.meshes.at(0).positions;
        ASSERT_EQ(positions.size(), 24u);
        float lowest = 1.0f, sum = 0.0f;
        for (std::size_t v = 0; v < 24; ++v) {
            EXPECT_EQ(positions[v].x, scene.meshes.at(0).positions[v].x);
            EXPECT_NEAR(glm::length(pose.meshes[0].normals[v]), 1.0f, 1e-5f);
            lowest = std::min(lowest, positions[v].y);
            sum += positions[v].y;
        }
        EXPECT_NEAR(lowest, known.lowest, 1e-7f) << known.time_s;
        EXPECT_NEAR(sum, known.sum, 1e-6f) << known.time_s;
    }
}

}  // namespace
}  // namespace pellucid
