#pragma once

// glTF files that move.
#include "gltf_builder.h"
#include "test_files.h"

#include <gtest/gtest.h>
#include <glm/glm.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace pellucid::test {

/// Adds a channel to the file's animation `animation`, which is made if it is not there.
inline void add_channel(GltfBuilder& b, int node, const char* path, const std::vector<float>& times,
                        const std::vector<float>& values, const char* type, int components,
                        const char* interpolation = "LINEAR", std::size_t animation = 0) {
    json& animations = b.root["animations"];
    while (animations.size() <= animation)
        animations.push_back({{"channels", json::array()}, {"samplers", json::array()}});
    json& a = animations[animation];
    a["samplers"].push_back({{"input", b.attribute(times, kFloat, "SCALAR", 1)},
                             {"output", b.attribute(values, kFloat, type, components)},
                             {"interpolation", interpolation}});
    a["channels"].push_back({{"sampler", int(a["samplers"].size()) - 1}, {"target", {{"node", node}, {"path", path}}}});
}

/// Half the square root of 2: x, y, z, w of a quarter turn about z are 0, 0, kHalfRoot, kHalfRoot.
constexpr float kHalfRoot = 0.70710678f;

/// A bar from y = 0 to y = 2, 0.2 wide, hinged at y = 1: joint 1 at the origin, its child joint 2 at (0, 1, 0).
/// Vertices in pairs x = -0.1, 0.1 at y = 0 (joint 1), y = 1 (half and half), y = 2 (joint 2), normals along x.
/// Animation "bend" turns joint 2 about z by 90 degrees from 1 s to 3 s.
inline GltfBuilder hinged_bar() {
    GltfBuilder b;
    const int position = b.attribute<float>({-0.1f, 0, 0, 0.1f, 0, 0, -0.1f, 1, 0, 0.1f, 1, 0, -0.1f, 2, 0, 0.1f, 2, 0},
                                            kFloat, "VEC3", 3);
    const int normal = b.attribute<float>({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, kFloat, "VEC3", 3);
    const int joints = b.attribute<std::uint8_t>(
        {0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, kUnsignedByte, "VEC4", 4);
    const int weights = b.attribute<float>(
        {1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, kFloat, "VEC4", 4);
    const int indices = b.attribute<std::uint16_t>({0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4}, kUnsignedShort, "SCALAR", 1);
    b.mesh({{"POSITION", position}, {"NORMAL", normal}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}},
           {{"indices", indices}});
    const int bind = b.attribute<float>(
        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1}, kFloat,
        "MAT4", 16);
    b.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", bind}}};
    b.root["scenes"][0]["nodes"] = {0, 1};
    b.node({{"mesh", 0}, {"skin", 0}, {"name", "bar"}, {"translation", {100, 200, 300}}});
    b.node({{"children", {2}}});
    b.node({{"translation", {0, 1, 0}}});
    add_channel(b, 2, "rotation", {1, 3}, {0, 0, 0, 1, 0, 0, kHalfRoot, kHalfRoot}, "VEC4", 4);
    b.root["animations"][0]["name"] = "bend";
    return b;
}

/// A triangle with two morph targets: the first lifts vertex 0 by (0, 0, 2) and tilts its normal, the second moves
/// vertex 1 by (4, 0, 0). Animation "grow" drives their weights from 0, 0 to 1, 0.5 in 2 s.
inline GltfBuilder morphed_triangle() {
    GltfBuilder b;
    const int position = b.attribute<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, kFloat, "VEC3", 3);
    const int normal = b.attribute<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 3);
    const int lift = b.attribute<float>({0, 0, 2, 0, 0, 0, 0, 0, 0}, kFloat, "VEC3", 3);
    const int tilt = b.attribute<float>({1, 0, -1, 0, 0, 0, 0, 0, 0}, kFloat, "VEC3", 3);
    const int which = b.view<std::uint16_t>({1});
    const int values = b.view<float>({4, 0, 0});
    const int sparse = b.accessor(-1, kFloat, "VEC3", 3,
                                  {{"sparse",
                                    {{"count", 1},
                                     {"indices", {{"bufferView", which}, {"componentType", kUnsignedShort}}},
                                     {"values", {{"bufferView", values}}}}}});
    b.mesh({{"POSITION", position}, {"NORMAL", normal}},
           {{"targets", {{{"POSITION", lift}, {"NORMAL", tilt}}, {{"POSITION", sparse}}}}});
    b.node({{"mesh", 0}, {"name", "thing"}});
    add_channel(b, 0, "weights", {0, 2}, {0, 0, 1, 0.5f}, "SCALAR", 1);
    b.root["animations"][0]["name"] = "grow";
    return b;
}

/// Rounding of single precision.
constexpr float kCloseTo = 2e-6f;

/// The file as load_scene() reads it.
inline Scene load(GltfBuilder& b, const LoadOptions& options = {}) {
    const TemporaryFolder folder;
    return load_scene(b.gltf(folder), options);
}

/// At a time of the first animation.
inline LoadOptions at(double time_s) {
    LoadOptions options;
    options.time_s = time_s;
    return options;
}

/// What loading ends with, empty if it loads.
inline std::string error_of(GltfBuilder& b, const LoadOptions& options = {}) {
    const TemporaryFolder folder;
    return load_error(b.gltf(folder), options);
}

inline void expect_near(const glm::vec3& a, const glm::vec3& b, const std::string& what = "") {
    EXPECT_LT(glm::length(a - b), kCloseTo)
        << what << ": " << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

}  // namespace pellucid::test
