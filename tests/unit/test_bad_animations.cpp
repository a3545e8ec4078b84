// Animations, skins and morph targets that cannot be as the file has them.
#include "animated_gltf.h"
#include "test_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace pellucid {
namespace {

using namespace test;
using testing::HasSubstr;

TEST(BadAnimations, AreErrorsInOneLine) {
    const auto refused = [](GltfBuilder b, const std::string& words, const std::function<void(GltfBuilder&)>& change) {
        change(b);
        const std::string error = error_of(b);
        EXPECT_THAT(error, HasSubstr(words));
        EXPECT_EQ(error.find('\n'), error.npos);
    };
    const auto attributes = [](GltfBuilder& b) -> json& { return b.root["meshes"][0]["primitives"][0]["attributes"]; };
    const auto sampler = [](GltfBuilder& b) -> json& { return b.root["animations"][0]["samplers"][0]; };
    const std::vector<float> ones(24, 1.0f), nans(24, NAN);

    refused(hinged_bar(), "follows joint 7, the skin has 2", [&](GltfBuilder& b) {
        attributes(b)["JOINTS_0"] = b.attribute(std::vector<std::uint8_t>(24, 7), kUnsignedByte, "VEC4", 4);
    });
    refused(hinged_bar(), "JOINTS_0: must be unsigned bytes or shorts",
            [&](GltfBuilder& b) { attributes(b)["JOINTS_0"] = b.attribute(ones, kFloat, "VEC4", 4); });
    refused(hinged_bar(), "WEIGHTS_0: a number is not finite",
            [&](GltfBuilder& b) { attributes(b)["WEIGHTS_0"] = b.attribute(nans, kFloat, "VEC4", 4); });
    refused(hinged_bar(), "need each other", [&](GltfBuilder& b) { attributes(b).erase("WEIGHTS_0"); });
    refused(hinged_bar(), "for 6 vertices", [&](GltfBuilder& b) {
        attributes(b)["WEIGHTS_0"] = b.attribute(std::vector<float>(20, 1.0f), kFloat, "VEC4", 4);
    });
    refused(hinged_bar(), "there is no skin 3", [&](GltfBuilder& b) { b.root["nodes"][0]["skin"] = 3; });
    refused(hinged_bar(), "joint 9 is no node", [&](GltfBuilder& b) { b.root["skins"][0]["joints"] = {1, 9}; });
    refused(hinged_bar(), "own ancestor", [&](GltfBuilder& b) { b.root["nodes"][2]["children"] = {1}; });
    refused(hinged_bar(), "joint 4 is no node of a tree", [&](GltfBuilder& b) {  // a circle apart from the scene
        b.node({{"children", {4}}});
        b.node({{"children", {3}}});
        b.root["skins"][0]["joints"] = {1, 4};
    });
    refused(hinged_bar(), "2 inverseBindMatrices for 3 joints", [&](GltfBuilder& b) {
        b.root["skins"][0]["joints"] = {1, 2, 1};
    });
    refused(hinged_bar(), "is not affine", [&](GltfBuilder& b) {
        b.root["skins"][0]["inverseBindMatrices"] = b.attribute(std::vector<float>(32, 1.0f), kFloat, "MAT4", 16);
    });
    refused(hinged_bar(), "a posed position is not finite", [&](GltfBuilder& b) {
        b.root["nodes"][1]["scale"] = {1e300, 1, 1};
        b.root["scenes"][0]["nodes"] = {0};
    });

    refused(hinged_bar(), "is before the one at 0", [&](GltfBuilder& b) {
        sampler(b)["input"] = b.attribute<float>({3, 1}, kFloat, "SCALAR", 1);
    });
    refused(hinged_bar(), "times: a number is not finite", [&](GltfBuilder& b) {
        sampler(b)["input"] = b.attribute<float>({0, NAN}, kFloat, "SCALAR", 1);
    });
    refused(hinged_bar(), "times: must be floats", [&](GltfBuilder& b) {
        sampler(b)["input"] = b.attribute<std::uint8_t>({0, 1}, kUnsignedByte, "SCALAR", 1);
    });
    refused(hinged_bar(), "has no keyframes",
            [&](GltfBuilder& b) { sampler(b)["input"] = b.accessor(-1, kFloat, "SCALAR", 0); });
    refused(hinged_bar(), "has 3 components, must have 4", [&](GltfBuilder& b) {
        sampler(b)["output"] = b.attribute<float>({0, 0, 1, 1, 0, 0}, kFloat, "VEC3", 3);
    });
    refused(hinged_bar(), "values: must be floats or normalized", [&](GltfBuilder& b) {
        sampler(b)["output"] = b.attribute(std::vector<std::uint8_t>(8, 1), kUnsignedByte, "VEC4", 4);
    });
    refused(hinged_bar(), "2 times need 8 numbers, there are 4", [&](GltfBuilder& b) {
        sampler(b)["output"] = b.attribute<float>({0, 0, 0, 1}, kFloat, "VEC4", 4);
    });
    refused(hinged_bar(), "2 times need 24 numbers, there are 8",
            [&](GltfBuilder& b) { sampler(b)["interpolation"] = "CUBICSPLINE"; });
    refused(hinged_bar(), "unknown interpolation 'BOUNCE'",
            [&](GltfBuilder& b) { sampler(b)["interpolation"] = "BOUNCE"; });
    refused(hinged_bar(), "rotation 1 is zero", [&](GltfBuilder& b) {
        sampler(b)["output"] = b.attribute<float>({0, 0, 0, 1, 0, 0, 0, 0}, kFloat, "VEC4", 4);
    });
    refused(hinged_bar(), "there is no sampler 5",
            [&](GltfBuilder& b) { b.root["animations"][0]["channels"][0]["sampler"] = 5; });
    refused(hinged_bar(), "there is no node 50",
            [&](GltfBuilder& b) { b.root["animations"][0]["channels"][0]["target"]["node"] = 50; });
    refused(morphed_triangle(), "2 times need 4 numbers, there are 2", [&](GltfBuilder& b) {
        sampler(b)["output"] = b.attribute<float>({0, 1}, kFloat, "SCALAR", 1);
    });
    refused(morphed_triangle(), "there is no accessor 99",
            [&](GltfBuilder& b) { b.root["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = 99; });
}

TEST(BadAnimations, WhatCanBeDoneWithoutIsAWarning) {
    const auto warned = [](GltfBuilder b, const std::string& words, const std::function<void(GltfBuilder&)>& change) {
        change(b);
        const Scene scene = load(b, at(1));
        EXPECT_EQ(broken_promise(scene), "");
        EXPECT_EQ(warnings_with(scene, words), 1u) << words;
    };
    const auto channel = [](GltfBuilder& b) -> json& { return b.root["animations"][0]["channels"][0]; };
    const auto target = [](GltfBuilder& b) -> json& { return b.root["meshes"][0]["primitives"][0]["targets"][0]; };
    warned(hinged_bar(), "1 time is repeated", [&](GltfBuilder& b) {
        b.root["animations"][0]["samplers"][0]["input"] = b.attribute<float>({1, 1}, kFloat, "SCALAR", 1);
    });
    warned(hinged_bar(), "'colour' is not animated", [&](GltfBuilder& b) { channel(b)["target"]["path"] = "colour"; });
    warned(hinged_bar(), "has no morph targets", [&](GltfBuilder& b) { channel(b)["target"]["path"] = "weights"; });
    warned(hinged_bar(), "stands where its matrix says", [&](GltfBuilder& b) {
        b.root["nodes"][2] = {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1}}};
    });
    warned(hinged_bar(), "its skin is ignored", [&](GltfBuilder& b) {
        json& attributes = b.root["meshes"][0]["primitives"][0]["attributes"];
        attributes.erase("JOINTS_0");
        attributes.erase("WEIGHTS_0");
    });
    warned(morphed_triangle(), "target 0 POSITION: left out: 1 values for 3", [&](GltfBuilder& b) {
        target(b)["POSITION"] = b.attribute<float>({0, 0, 1}, kFloat, "VEC3", 3);
    });
    warned(morphed_triangle(), "target 0 NORMAL: left out: not finite",
           [&](GltfBuilder& b) { target(b)["NORMAL"] = b.attribute(std::vector<float>(9, NAN), kFloat, "VEC3", 3); });
    warned(morphed_triangle(), "target 0 COLOR_0: left out", [&](GltfBuilder& b) { target(b)["COLOR_0"] = 0; });
}

}  // namespace
}  // namespace pellucid
