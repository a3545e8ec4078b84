// Compressed glTF files give what the same files give uncompressed.
#include "animated_gltf.h"
#include "compressed_gltf.h"
#include "test_files.h"

#include <pellucid/animation.h>

#include <gtest/gtest.h>

namespace pellucid {
namespace {

using namespace test;

std::size_t number(const json& object, const char* key) { return object.value(key, std::size_t(0)); }

/// Writes the file with a second buffer that holds nothing, as gltfpack does.
std::string meshopt_file(GltfBuilder& b, const TemporaryFolder& folder) {
    const std::string file = b.gltf(folder);
    b.root["buffers"].push_back(
        {{"byteLength", 1 << 20}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
    return folder.file("a.gltf", b.root.dump());
}

/// Every buffer view of whole multiples of 4 bytes, encoded.
void compress_all_views(GltfBuilder& b) {
    for (std::size_t view = 0; view < b.root["bufferViews"].size(); ++view) {
        const json v = b.root["bufferViews"][view];
        const std::size_t length = number(v, "byteLength");
        if (length % 4 != 0) continue;
        const std::string bytes = b.bin.substr(number(v, "byteOffset"), length);
        set_meshopt(b, int(view), encoded_vertices(bytes.data(), length / 4, 4), 4, length / 4, "ATTRIBUTES");
        // Views that accessors with strides of their own read are tightly packed here.
    }
}

void expect_same_poses(const Scene& a, const Scene& b, double time) {
    const Pose first = pose_at(a, 0, time), second = pose_at(b, 0, time);
    ASSERT_EQ(first.meshes.size(), second.meshes.size());
    for (std::size_t m = 0; m < first.meshes.size(); ++m) {
        EXPECT_EQ(first.meshes[m].positions, second.meshes[m].positions);
        EXPECT_EQ(first.meshes[m].normals, second.meshes[m].normals);
    }
}

TEST(Meshopt, SkinsMorphTargetsAndAnimationsAreWhatTheyWere) {
    for (const auto& make : {hinged_bar, morphed_triangle}) {
        const TemporaryFolder plain, packed;
        GltfBuilder b = make();
        const Scene uncompressed = load_scene(b.gltf(plain));
        compress_all_views(b);
        const Scene scene = load_scene(meshopt_file(b, packed));
        EXPECT_EQ(scene.warnings, uncompressed.warnings);
        ASSERT_EQ(scene.meshes.size(), 1u);
        EXPECT_EQ(scene.meshes[0].positions, uncompressed.meshes[0].positions);
        EXPECT_EQ(scene.meshes[0].triangles, uncompressed.meshes[0].triangles);
        expect_same_poses(uncompressed, scene, 1.7);
    }
}

/// Two triangles whose indices are stored as `mode` says.
Scene square_with_indices(const char* mode, std::size_t stride) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    const std::vector<unsigned> indices = {0, 1, 2, 2, 1, 3};
    json& primitive = b.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] = b.attribute<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, kFloat, "VEC3", 3);
    const int view = b.view<std::uint16_t>({9, 9, 9, 9, 9, 9});
    primitive["indices"] = b.accessor(view, stride == 2 ? kUnsignedShort : kUnsignedInt, "SCALAR", 6);
    std::vector<unsigned char> encoded(1000);
    const bool triangles = std::string(mode) == "TRIANGLES";
    encoded.resize(triangles ? meshopt_encodeIndexBuffer(encoded.data(), encoded.size(), indices.data(), 6)
                             : meshopt_encodeIndexSequence(encoded.data(), encoded.size(), indices.data(), 6));
    set_meshopt(b, view, encoded, stride, 6, mode);
    return load_scene(meshopt_file(b, folder));
}

TEST(Meshopt, TrianglesAndIndices) {
    for (const char* mode : {"TRIANGLES", "INDICES"}) {
        for (const std::size_t stride : {std::size_t(2), std::size_t(4)}) {
            const Scene scene = square_with_indices(mode, stride);
            EXPECT_EQ(scene.triangle_count(), 2u) << mode;
            EXPECT_EQ(scene.meshes[0].normals[3], glm::vec3(0, 0, 1)) << mode;
        }
    }
}

TEST(Meshopt, Filters) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    json& primitive = b.root["meshes"][0]["primitives"][0];

    const float normals[] = {0.6f, 0, 0.8f, 0, 0, 0.6f, 0.8f, 0, 0, 0, 1, 0};
    std::vector<std::int8_t> octahedral(12);
    meshopt_encodeFilterOct(octahedral.data(), 3, 4, 8, normals);
    const int normal_view = b.view<std::int8_t>(std::vector<std::int8_t>(12), 4);
    set_meshopt(b, normal_view, encoded_vertices(octahedral.data(), 3, 4), 4, 3, "ATTRIBUTES", "OCTAHEDRAL");
    primitive["attributes"]["NORMAL"] = b.accessor(normal_view, kByte, "VEC3", 3, {{"normalized", true}});

    const float positions[] = {0, 0, 0.25f, 3, 0, 0.25f, 0, 5, 0.25f};
    std::vector<std::uint32_t> exponential(9);
    meshopt_encodeFilterExp(exponential.data(), 3, 12, 20, positions);
    const int position_view = b.view<float>(std::vector<float>(9));
    set_meshopt(b, position_view, encoded_vertices(exponential.data(), 3, 12), 12, 3, "ATTRIBUTES", "EXPONENTIAL");
    primitive["attributes"]["POSITION"] = b.accessor(position_view, kFloat, "VEC3", 3);

    // A quarter turn about z at both keys.
    const float quarter[] = {0, 0, kHalfRoot, kHalfRoot, 0, 0, kHalfRoot, kHalfRoot};
    std::vector<std::int16_t> quaternions(8);
    meshopt_encodeFilterQuat(quaternions.data(), 2, 8, 16, quarter);
    add_channel(b, 0, "rotation", {0, 1}, std::vector<float>(8), "VEC4", 4);
    const int rotation_view = b.view<std::int16_t>(std::vector<std::int16_t>(8));
    set_meshopt(b, rotation_view, encoded_vertices(quaternions.data(), 2, 8), 8, 2, "ATTRIBUTES", "QUATERNION");
    b.root["animations"][0]["samplers"][0]["output"] =
        b.accessor(rotation_view, kShort, "VEC4", 2, {{"normalized", true}});

    LoadOptions turned;
    turned.time_s = 0.5;
    const Scene scene = load_scene(meshopt_file(b, folder), turned);
    EXPECT_EQ(scene.meshes[0].positions[2], glm::vec3(0, 5, 0.25f));
    EXPECT_LT(glm::length(scene.meshes[0].normals[0] - glm::vec3(0.6f, 0, 0.8f)), 0.02f);
    const glm::vec3 x = scene.objects[0].world_from_object * glm::vec4(1, 0, 0, 0);
    EXPECT_LT(glm::length(x - glm::vec3(0, 1, 0)), 1e-3f);
}

TEST(Meshopt, DamagedDataIsRefusedByView) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::vector<unsigned char> good = encoded_vertices(positions, 3, 12);
    set_meshopt(b, 0, good, 12, 3, "ATTRIBUTES");
    const json root = b.root;
    const auto error_with = [&](const char* key, json value) {
        b.root = root;
        b.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = std::move(value);
        return load_error(meshopt_file(b, folder));
    };
    EXPECT_EQ(error_with("count", 3), "");
    for (const std::string& error :
         {error_with("byteLength", good.size() - 3), error_with("byteLength", 1 << 20), error_with("count", 4000000000),
          error_with("count", -1), error_with("byteStride", 3), error_with("byteStride", 0), error_with("mode", "FAST"),
          error_with("filter", "BLUR"), error_with("filter", "QUATERNION"), error_with("buffer", 7),
          error_with("mode", "TRIANGLES")})
        EXPECT_NE(error.find("buffer view 0: meshopt data cannot be decoded"), error.npos) << error;
}

TEST(Draco, BothMethodsGiveTheSquare) {
    for (const bool sequential : {false, true}) {
        const TemporaryFolder folder;
        GltfBuilder b = draco_file(draco_square(sequential));
        const Scene scene = load_scene(b.gltf(folder));
        EXPECT_EQ(broken_promise(scene), "");
        EXPECT_TRUE(scene.warnings.empty());
        EXPECT_EQ(scene.triangle_count(), 2u);
        const Mesh& mesh = scene.meshes.at(0);
        glm::vec3 sum(0.0f);
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            EXPECT_EQ(mesh.normals[v], glm::vec3(0, 0, 1));
            EXPECT_EQ(mesh.texcoords[0][v], glm::vec2(mesh.positions[v]));
            sum += mesh.positions[v];
        }
        EXPECT_EQ(mesh.positions.size() == 6 ? sum : sum * 1.5f, glm::vec3(3, 3, 0));
    }
}

TEST(Draco, MorphTargetsBesideIt) {
    const TemporaryFolder folder;
    GltfBuilder b = draco_file(draco_square(true));
    const int lift = b.attribute<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 3);
    json& mesh = b.root["meshes"][0];
    mesh["primitives"][0]["targets"] = {{{"POSITION", lift}}};
    mesh["weights"] = {0.5};
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_EQ(scene.triangle_count(), 2u);
    for (const glm::vec3& p : scene.meshes.at(0).positions) EXPECT_EQ(p.z, 0.5f);
}

TEST(Draco, StripsAreTakenApart) {
    const TemporaryFolder folder;
    GltfBuilder b = draco_file(draco_square(false));
    b.root["meshes"][0]["primitives"][0]["mode"] = 5;
    EXPECT_EQ(load_scene(b.gltf(folder)).triangle_count(), 2u);
}

TEST(Draco, WhatCannotBeDecodedIsRefusedOrDrawnUncompressed) {
    const TemporaryFolder folder;
    DracoSquare square = draco_square(false);
    square.bytes.resize(square.bytes.size() / 2);
    GltfBuilder b = draco_file(square);
    const std::string error = load_error(b.gltf(folder));
    EXPECT_NE(error.find("a.gltf: mesh thing primitive 0: Draco data cannot be decoded ("), error.npos) << error;
    EXPECT_NE(error.find("export the file again"), error.npos) << error;

    json& primitive = b.root["meshes"][0]["primitives"][0];
    primitive["attributes"] = {{"POSITION", b.attribute<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, kFloat, "VEC3", 3)}};
    primitive.erase("indices");
    const Scene scene = load_scene(b.gltf(folder));
    EXPECT_EQ(scene.triangle_count(), 1u);
    EXPECT_EQ(warnings_with(scene, "mesh thing primitive 0: Draco data left out"), 1u);
}

}  // namespace
}  // namespace pellucid
