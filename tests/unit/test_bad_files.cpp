// Files that are damaged, hostile or just strange: each loads, or is refused with one line.
// What is tested is also what is not seen: no crash, no hang, no sanitizer report.
#include "gltf_builder.h"
#include "test_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <set>

// assimp forgets some memory where it gives up on a file.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp\n"; }

namespace pellucid {
namespace {

using namespace test;

/// Loads and checks that the outcome is a sound scene or a one-line Error that names the file.
/// Returns the error.
std::string outcome(const std::string& source, const std::string& name) {
    try {
        const Scene scene = load_scene(source);
        EXPECT_EQ(broken_promise(scene), "") << source;
        return {};
    } catch (const Error& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find(name), std::string::npos) << what;
        EXPECT_EQ(what.find('\n'), std::string::npos) << what;
        return what;
    }
}

const char kObj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nf 1//1 3//1 2//1\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
const char kPly[] =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
const char kOff[] = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
const char kStl[] =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid "
    "a\n";

std::vector<std::pair<std::string, std::string>> good_files() {
    std::string binary_ply =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::int32_t face[] = {0, 1, 2};
    binary_ply.append(reinterpret_cast<const char*>(positions), sizeof positions) += '\3';
    binary_ply.append(reinterpret_cast<const char*>(face), sizeof face);
    std::string binary_stl(80, ' ');
    binary_stl += std::string("\1\0\0\0", 4) + std::string(12, '\0');
    binary_stl.append(reinterpret_cast<const char*>(positions), sizeof positions).append(2, '\0');
    GltfBuilder gltf = GltfBuilder::triangle();
    const std::string glb = gltf.glb_bytes();
    gltf.root["buffers"][0]["uri"] =
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    return {{"a.obj", kObj}, {"a.ply", kPly},       {"b.ply", binary_ply}, {"a.off", kOff},
            {"a.stl", kStl}, {"b.stl", binary_stl}, {"a.glb", glb},        {"a.gltf", gltf.root.dump()}};
}

TEST(BadFiles, TheGoodOnesAreGood) {
    const TemporaryFolder folder;
    for (const auto& [name, content] : good_files()) EXPECT_EQ(outcome(folder.file(name, content), name), "");
}

TEST(BadFiles, MissingEmptyAndFolders) {
    const TemporaryFolder folder;
    for (const char* extension : {".gltf", ".glb", ".obj", ".ply", ".stl", ".off", ".3ds"}) {
        const std::string name = "x" + std::string(extension);
        EXPECT_NE(outcome((folder / name).string(), name).find("no such file"), std::string::npos);
        EXPECT_NE(outcome(folder.file(name, ""), name).find("is empty"), std::string::npos);
        std::filesystem::remove(folder / name);
        std::filesystem::create_directory(folder / name);
        EXPECT_NE(outcome((folder / name).string(), name).find("is a folder"), std::string::npos);
    }
}

TEST(BadFiles, TruncatedAnywhere) {
    const TemporaryFolder folder;
    for (const auto& [name, content] : good_files())
        for (std::size_t size = 1; size < content.size(); ++size)
            outcome(folder.file(name, content.substr(0, size)), name);
}

TEST(BadFiles, TruncatedInWaysThatMustBeNoticed) {
    const TemporaryFolder folder;
    for (const auto& [name, content] : good_files()) {
        if (name == "a.obj") continue;
        EXPECT_NE(outcome(folder.file(name, content.substr(0, content.size() * 3 / 4)), name), "") << name;
    }
    // An OBJ file announces nothing; only a face cut off from its vertices shows.
    EXPECT_NE(outcome(folder.file("a.obj", "v 0 0 0\nv 1 0 0\n"), "a.obj").find("contains no"), std::string::npos);
}

TEST(BadFiles, DamagedBytes) {
    const TemporaryFolder folder;
    std::mt19937 random(1);
    for (const auto& [name, content] : good_files()) {
        for (int round = 0; round < 300; ++round) {
            std::string damaged = content;
            for (unsigned n = 1 + random() % 3; n > 0; --n)
                damaged[random() % damaged.size()] = static_cast<char>(round % 2 ? random() : '0' + random() % 10);
            outcome(folder.file(name, damaged), name);
        }
    }
}

TEST(BadFiles, RandomBytes) {
    const TemporaryFolder folder;
    std::mt19937 random(2);
    for (const char* name : {"r.gltf", "r.glb", "r.obj", "r.ply", "r.stl", "r.off", "r.3ds"}) {
        for (const std::size_t size : {1u, 4u, 20u, 83u, 84u, 85u, 1000u, 50000u}) {
            std::string bytes(size, '\0');
            for (char& c : bytes) c = static_cast<char>(random());
            EXPECT_NE(outcome(folder.file(name, bytes), name), "");
            for (const std::string& magic : {std::string("glTF\2\0\0\0", 8), std::string("MM"), std::string("OFF\n"),
                                             std::string("solid"), std::string("ply\n")})
                outcome(folder.file(name, magic + bytes), name);
        }
    }
}

TEST(BadFiles, NumbersThatAreNone) {
    const TemporaryFolder folder;
    EXPECT_NE(outcome(folder.file("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "nan.obj"), "");
    EXPECT_NE(outcome(folder.file("inf.obj", "v inf 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "inf.obj"), "");
    EXPECT_NE(outcome(folder.file("nan.off", "OFF\n3 1 0\nnan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "nan.off"), "");
    EXPECT_NE(
        outcome(folder.file("far.obj", "v 1e30 0 0\nv 0 1e30 0\nv 0 0 1e30\nf 1 2 3\n"), "far.obj").find("too large"),
        std::string::npos);
    EXPECT_NE(outcome(folder.file("one.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n"), "one.obj").find("no triangles"),
              std::string::npos);
    for (const float bad : {NAN, INFINITY}) {
        GltfBuilder b;
        b.mesh({{"POSITION", b.attribute<float>({0, 0, 0, 1, bad, 0, 0, 1, 0}, kFloat, "VEC3", 3)}});
        b.node({{"mesh", 0}});
        EXPECT_NE(outcome(b.gltf(folder), "a.gltf").find("mesh thing primitive 0: a position is not finite"),
                  std::string::npos);
    }
}

TEST(BadFiles, IndicesOutOfRange) {
    const TemporaryFolder folder;
    for (const char* face :
         {"f 1 2 4", "f 0 1 2", "f -1 -2 -4", "f 1 2 99999999999999999999", "f 1 2 -2147483648", "f 1//1 2//1 3//7"})
        EXPECT_NE(
            outcome(folder.file("i.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\n" + std::string(face) + "\n"), "i.obj"),
            "")
            << face;
    for (const char* face : {"3 0 1 3", "3 0 1 -1", "4 0 1 2", "3 0 1 99999999999999999999"})
        EXPECT_NE(
            outcome(folder.file("i.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n" + std::string(face) + "\n"), "i.off"), "")
            << face;
    for (const char* index : {"4", "-1", "99999999999999999999", "1.5"})
        EXPECT_NE(outcome(folder.file("i.ply", std::string(kPly, sizeof kPly - 3) + index + "\n"), "i.ply"), "")
            << index;
}

TEST(BadFiles, CountsThatTheFileIsTooShortFor) {
    const TemporaryFolder folder;
    for (const char* count :
         {"5", "1000000", "353535235358", "18446744073709551615", "99999999999999999999999", "-1", "x"}) {
        std::string ply = kPly, off = kOff;
        ply.replace(ply.find("vertex 4") + 7, 1, count);
        EXPECT_NE(outcome(folder.file("c.ply", ply), "c.ply"), "") << count;
        ply = kPly;
        ply.replace(ply.find("face 4") + 5, 1, count);
        EXPECT_NE(outcome(folder.file("c.ply", ply), "c.ply"), "") << count;
        off.replace(off.find("4 4"), 1, count);
        EXPECT_NE(outcome(folder.file("c.off", off), "c.off"), "") << count;
    }
    std::string stl(84, ' ');
    stl.replace(80, 4, "\xff\xff\xff\x7f");
    EXPECT_NE(outcome(folder.file("c.stl", stl), "c.stl"), "");
    EXPECT_NE(outcome(folder.file("c.3ds", "MM\xff\xff\xff\x7f"), "c.3ds"), "");
}

TEST(BadFiles, GltfReferencesOutOfRange) {
    const TemporaryFolder folder;
    const auto error_after = [&](const std::function<void(json&)>& change) {
        GltfBuilder b = GltfBuilder::triangle();
        b.mesh({{"POSITION", 0}}, {{"indices", b.attribute<std::uint16_t>({0, 1, 2}, kUnsignedShort, "SCALAR", 1)}});
        b.node({{"mesh", 1}});
        b.root["scenes"][0]["nodes"] = {0, 1};
        b.gltf(folder);
        change(b.root);
        return outcome(folder.file("a.gltf", b.root.dump()), "a.");
    };
    EXPECT_EQ(error_after([](json&) {}), "");
    const auto primitive = [](json& root) -> json& { return root["meshes"][1]["primitives"][0]; };
    const std::function<void(json&)> changes[] = {
        [&](json& r) { primitive(r)["attributes"]["POSITION"] = 9; },
        [&](json& r) {
            primitive(r)["attributes"]["POSITION"] = -1000;
            r["meshes"][0]["primitives"][0]["mode"] = 9;
        },
        [&](json& r) { primitive(r)["attributes"]["NORMAL"] = 99; },
        [&](json& r) { primitive(r)["indices"] = 99; },
        [&](json& r) { primitive(r)["material"] = 0; },
        [&](json& r) { r["accessors"][0]["count"] = 4; },
        [&](json& r) { r["accessors"][0]["count"] = 18446744073709551615ull; },
        [&](json& r) { r["accessors"][0]["byteOffset"] = 18446744073709551615ull; },
        [&](json& r) { r["accessors"][0]["byteOffset"] = 1; },
        [&](json& r) { r["accessors"][0]["bufferView"] = 7; },
        [&](json& r) {
            r["accessors"][0].erase("bufferView");
            r["accessors"][0]["count"] = 1000000000000ull;
        },
        [&](json& r) { r["accessors"][0]["componentType"] = 5130; },
        [&](json& r) { r["accessors"][0]["componentType"] = 5124; },
        [&](json& r) { r["accessors"][0]["componentType"] = 1; },
        [&](json& r) { r["accessors"][0]["type"] = "VEC2"; },
        [&](json& r) { r["accessors"][0]["type"] = "MAT4"; },
        [&](json& r) { r["accessors"][1]["componentType"] = kFloat; },
        [&](json& r) { r["bufferViews"][0]["byteOffset"] = 18446744073709551615ull; },
        [&](json& r) { r["bufferViews"][0]["byteLength"] = 18446744073709551615ull; },
        [&](json& r) { r["bufferViews"][0]["byteStride"] = 4; },
        [&](json& r) { r["bufferViews"][0]["byteStride"] = 252; },
        [&](json& r) { r["bufferViews"][0]["buffer"] = 3; },
        [&](json& r) { r["buffers"][0]["byteLength"] = 1000000; },
        [&](json& r) { r["buffers"][0]["byteLength"] = -1; },
        [&](json& r) { r["buffers"][0]["uri"] = "missing-a.bin"; },
        [&](json& r) { r["buffers"][0].erase("uri"); },
        [&](json& r) {
            r["accessors"][0]["sparse"] = {
                {"count", 1},
                {"indices", {{"bufferView", 1}, {"componentType", kUnsignedShort}, {"byteOffset", 6}}},
                {"values", {{"bufferView", 0}}}};
        },
        [&](json& r) {
            r["accessors"][0]["sparse"] = {{"count", -1},
                                           {"indices", {{"bufferView", 1}, {"componentType", kUnsignedShort}}},
                                           {"values", {{"bufferView", 0}}}};
        },
        [&](json& r) { r["nodes"][0]["mesh"] = 5; },
        [&](json& r) { r["nodes"][0]["camera"] = 5; },
        [&](json& r) { r["nodes"][0]["children"] = {-7}; },
        [&](json& r) { r["nodes"][0]["children"] = {0}; },
        [&](json& r) { r["asset"]["version"] = "1.0"; },
        [&](json& r) { r.erase("asset"); }};
    for (std::size_t i = 0; i < std::size(changes); ++i) EXPECT_NE(error_after(changes[i]), "") << "change " << i;
}

TEST(BadFiles, GltfWithValuesOfWrongTypes) {
    // Every value of a file that uses most of the format, exchanged for values of every type.
    const TemporaryFolder folder;
    folder.file("no-image.png", "x");
    GltfBuilder b = GltfBuilder::triangle();
    b.root["images"] = {{{"uri", "no-image.png"}}, {{"bufferView", 0}}};
    b.root["samplers"] = {{{"wrapS", 33071}}};
    b.root["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 1}}};
    b.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
    b.root["extensionsUsed"] = {"KHR_materials_volume"};
    const json info = {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"offset", {0, 1}}}}}}};
    b.root["materials"] = {
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {1, 1, 1, 1}},
           {"baseColorTexture", info},
           {"metallicRoughnessTexture", {{"index", 1}}}}},
         {"normalTexture", {{"index", 1}}},
         {"emissiveFactor", {1, 1, 1}},
         {"emissiveTexture", info},
         {"extensions",
          {{"KHR_materials_transmission", {{"transmissionFactor", 1}, {"transmissionTexture", info}}},
           {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationColor", {1, 1, 1}}}}}}}};
    b.root["meshes"][0]["primitives"][0]["material"] = 0;
    b.node({{"camera", 0}, {"rotation", {0, 0, 0, 1}}, {"scale", {1, 1, 1}}});
    b.root["nodes"][0]["children"] = {1};
    b.gltf(folder);
    const json substitutes[] = {nullptr,    true,           -1,        7, 1e300, "text", json::array(),
                                {1, "two"}, json::object(), {{"a", 1}}};
    const json flat = b.root.flatten();
    std::set<std::string> places;
    for (const auto& [place, value] : flat.items())
        for (std::size_t end = place.find('/', 1);; end = place.find('/', end + 1)) {
            places.insert(place.substr(0, end));
            if (end == std::string::npos) break;
        }
    EXPECT_EQ(outcome(folder.file("t.gltf", b.root.dump()), "t.gltf"), "");
    for (const std::string& place : places)
        for (const json& substitute : substitutes) {
            json changed = b.root;
            changed[json::json_pointer(place)] = substitute;
            outcome(folder.file("t.gltf", changed.dump()), "");
        }
}

TEST(BadFiles, JsonNestedTooDeeply) {
    const TemporaryFolder folder;
    const std::string deep(1000000, '[');
    EXPECT_NE(outcome(folder.file("d.gltf", "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + deep), "d.gltf"), "");
    const std::string closed = deep + std::string(deep.size(), ']');
    EXPECT_NE(outcome(folder.file("e.gltf", "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + closed + "}"), "e.gltf")
                  .find("deep"),
              std::string::npos);
}

TEST(BadFiles, GlbHeadersThatLie) {
    const TemporaryFolder folder;
    GltfBuilder b = GltfBuilder::triangle();
    const std::string good = b.glb_bytes();
    for (const std::size_t at : {4u, 8u, 12u, 16u}) {
        for (const std::uint32_t value : {0u, 1u, 3u, 0x7fffffffu, 0xffffffffu}) {
            std::string bytes = good;
            std::memcpy(bytes.data() + at, &value, 4);
            EXPECT_NE(outcome(folder.file("h.glb", bytes), "h.glb"), "") << at << " " << value;
        }
    }
}

struct Known {
    const char* file;
    const char* error;  ///< part of the message; empty: loads
};
const Known kKnown[] = {{"gltf/assimp_BoxBadNormals-glTF-Binary/BoxBadNormals.glb", ""},
                        {"gltf/assimp_BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", "not finite"},
                        {"gltf/assimp_IncorrectVertexArrays/Cube.gltf", ""},
                        {"gltf/assimp_IndexOutOfRange/AllIndicesOutOfRange.gltf", "refers to vertex 65535"},
                        {"gltf/assimp_IndexOutOfRange/IndexOutOfRange.gltf", "refers to vertex 255"},
                        {"gltf/assimp_MissingBin/BoxTextured.gltf", "BoxTextured0.bin: no such file"},
                        {"gltf/assimp_RecursiveNodes/RecursiveNodes.gltf", "own ancestor"},
                        {"gltf/assimp_SchemaFailures/sceneWrongType.gltf", "BoxTextured0.bin: no such file"},
                        {"gltf/assimp_TestNoRootNode/NoScene.gltf", "no triangles"},
                        {"gltf/assimp_TestNoRootNode/SceneWithoutNodes.gltf", "no triangles"},
                        {"gltf/assimp_issue_3269/texcoord_crash.gltf", ""},
                        {"gltf/assimp_wrongTypes/badArray.gltf", "no triangles"},
                        {"gltf/assimp_wrongTypes/badExtension.gltf", ""},
                        {"gltf/assimp_wrongTypes/badNumber.gltf", ""},
                        {"gltf/assimp_wrongTypes/badObject.gltf", ""},
                        {"gltf/assimp_wrongTypes/badString.gltf", ""},
                        {"gltf/assimp_wrongTypes/badUint.gltf", ""},
                        {"ply_off/assimp_OutOfMemory.off", "353535235358 vertices"},
                        {"ply_off/assimp_crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply", "end_header"},
                        {"ply_off/assimp_empty.off", "is empty"},
                        {"ply_off/assimp_empty.ply", "is empty"},
                        {"ply_off/assimp_invalid.off", "OFF"},
                        {"obj/assimp_empty.obj", "is empty"},
                        {"obj/assimp_malformed.obj", "line 28: face refers to a vertex"},
                        {"obj/assimp_number_formats.obj", "line 11: \"3.1+e2\" is no number"},
                        {"obj/assimp_point_cloud.obj", "no triangles"},
                        {"obj/assimp_testline.obj", "no triangles"},
                        {"obj/tinyobj_invalid-face-definition.obj", "no triangles"},
                        {"obj/tinyobj_invalid-relative-texture-index.obj", "line 2: face refers to vertex 1"},
                        {"obj/tinyobj_invalid-relative-vertex-index.obj", "line 1: face refers to a vertex"},
                        {"obj/tinyobj_issue-140-zero-face-idx.obj", "line 16: face refers to a vertex"},
                        {"obj/tinyobj_issue-356-leading-spaces-newmtl.obj", "no triangles"},
                        {"obj/tinyobj_line-prim.obj", "no triangles"},
                        {"obj/tinyobj_points-prim.obj", "no triangles"},
                        {"obj/tinyobj_test-nan.obj", "not finite"}};

TEST(BadFiles, Collected) {
    const std::filesystem::path folder = data_folder() / "bad";
    if (data_folder().empty()) GTEST_SKIP() << "PELLUCID_TEST_DATA does not name a folder";
    std::size_t seen = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        const std::string name = std::filesystem::relative(entry.path(), folder).generic_string();
        SCOPED_TRACE(name);
        const std::string error = outcome(entry.path().string(), folder.string());
        const auto known =
            std::find_if(std::begin(kKnown), std::end(kKnown), [&](const Known& k) { return name == k.file; });
        const std::string extension = entry.path().extension().string();
        if (known != std::end(kKnown)) {
            ++seen;
            EXPECT_EQ(error.empty(), *known->error == '\0') << error;
            EXPECT_NE(error.find(known->error), std::string::npos) << error;
        } else if (extension == ".obj") {
            EXPECT_EQ(error, "") << "every OBJ file that is not in the table loads";
        } else {
            EXPECT_NE(error.find("unknown kind of file"), std::string::npos) << error;
        }
    }
    EXPECT_EQ(seen, std::size(kKnown));
}

}  // namespace
}  // namespace pellucid
