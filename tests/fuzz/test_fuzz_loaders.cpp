// Small valid files of every kind that is read, damaged at random but always in the same way: each
// loads or is refused with an Error. Anything else (another exception, a crash, a sanitizer's report)
// is a bug. A file that is slow to refuse shows as the test's time limit.
#include "unit/animated_gltf.h"
#include "unit/compressed_gltf.h"
#include "unit/gltf_builder.h"
#include "unit/test_files.h"

#include <pellucid/animation.h>
#include <pellucid/environment.h>
#include <pellucid/image.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <functional>
#include <random>
#include <string>

namespace pellucid {
namespace {

using namespace test;
using Random = std::mt19937;

constexpr int kRounds = 1500;      // for each kind of scene file
constexpr int kImageRounds = 300;  // images may name sizes that take long to make room for

std::size_t pick(Random& random, std::size_t count) { return count == 0 ? 0 : random() % count; }

// --- ways to damage a file --------------------------------------------------------------------------

void flip_bytes(std::string& bytes, Random& random) {
    for (std::size_t count = 1 + pick(random, 8); count > 0 && !bytes.empty(); --count)
        bytes[pick(random, bytes.size())] = char(random());
}

void truncate(std::string& bytes, Random& random) { bytes.resize(pick(random, bytes.size())); }

void repeat_piece(std::string& bytes, Random& random) {
    const std::size_t begin = pick(random, bytes.size());
    const std::string piece = bytes.substr(begin, 1 + pick(random, 64));
    for (std::size_t count = 1 + pick(random, 20); count > 0; --count) bytes.insert(pick(random, bytes.size()), piece);
}

void remove_piece(std::string& bytes, Random& random) {
    if (!bytes.empty()) bytes.erase(pick(random, bytes.size()), 1 + pick(random, 32));
}

/// Numbers in text: counts, indices and coordinates as no exporter writes them.
void insert_text_number(std::string& bytes, Random& random) {
    constexpr std::array kNumbers = {
        "99999999999999999999", "-1",     "4294967295", "2147483648", "1e999", "nan", "-inf", "0", "1e38",
        "18446744073709551615", "1e-320", "."};
    const std::size_t digit = bytes.find_first_of("0123456789", pick(random, bytes.size()));
    if (digit == bytes.npos) return;
    const std::size_t end = std::min(bytes.find_first_not_of("0123456789.", digit), bytes.size());
    bytes.replace(digit, end - digit, kNumbers[pick(random, kNumbers.size())]);
}

/// The same in binary: sizes, offsets and floats.
void insert_binary_number(std::string& bytes, Random& random) {
    constexpr std::array<std::uint32_t, 8> kWords = {0xffffffffu, 0x7fffffffu, 0x80000000u, 0x7fc00000u,
                                                     0x7f800000u, 0u,          0x00010000u, 0x40000000u};
    if (bytes.size() < 4) return;
    const std::uint32_t word = kWords[pick(random, kWords.size())];
    std::memcpy(bytes.data() + pick(random, bytes.size() - 3), &word, sizeof word);
}

std::string damaged(std::string bytes, Random& random) {
    constexpr std::array kWays = {flip_bytes,   truncate,           repeat_piece,
                                  remove_piece, insert_text_number, insert_binary_number};
    for (std::size_t count = 1 + pick(random, 3); count > 0; --count) kWays[pick(random, kWays.size())](bytes, random);
    return bytes;
}

// --- the test of one kind ---------------------------------------------------------------------------

/// Damages `good`, a file called `name`, in many ways and lets `load` read each. The intact one loads. `refuses`: of
/// damaged ones, one in 20 does not.
void fuzz(const std::string& name, const std::string& good, const std::function<void(const std::string&)>& load,
          int rounds = kRounds, bool refuses = true) {
    const TemporaryFolder folder;
    ASSERT_NO_THROW(load(folder.file(name, good)));
    std::seed_seq seed(name.begin(), name.end());
    Random random(seed);
    int refused = 0;
    for (int round = 0; round < rounds; ++round) {
        const std::string file = folder.file(name, damaged(good, random));
        try {
            load(file);
        } catch (const Error& error) {
            ++refused;
            const std::string what = error.what();
            EXPECT_EQ(what.find('\n'), what.npos) << what;
            EXPECT_NE(what.find(name), what.npos) << what;
        } catch (const std::exception& error) {
            ADD_FAILURE() << name << ", round " << round << ": " << error.what();
        }
    }
    if (!refuses) return;
    EXPECT_GT(refused, rounds / 20) << "the damage is too light to show anything";
}

void load_checked(const std::string& file) { EXPECT_EQ(broken_promise(load_scene(file)), ""); }

/// At rest and in every animation: a pose is refused or fits the scene.
void load_posed(const std::string& file) {
    const Scene scene = load_scene(file);
    EXPECT_EQ(broken_promise(scene), "");
    const std::size_t count = animations(scene).size();
    for (std::size_t animation = 0; animation < count; ++animation) {
        Scene posed = scene;
        const Pose pose = pose_at(scene, animation, 1.7);
        for (const PosedMesh& mesh : pose.meshes) {
            posed.meshes.at(std::size_t(mesh.mesh)).positions = mesh.positions;
            posed.meshes.at(std::size_t(mesh.mesh)).normals = mesh.normals;
        }
        EXPECT_EQ(broken_promise(posed), "");
    }
}

void load_image(const std::string& file) {
    const Image image = read_image(file);
    EXPECT_EQ(image.pixels.size(), std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels));
}

void load_map(const std::string& file) { irradiance_coefficients(load_environment(file)); }

// --- small valid files ------------------------------------------------------------------------------

template <class T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

constexpr float kPositions[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr std::int32_t kTriangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

std::string ply(bool binary) {
    std::string bytes = std::string("ply\nformat ") + (binary ? "binary_little_endian" : "ascii") +
                        " 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                        "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
    if (!binary) return bytes + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    append(bytes, kPositions);
    for (const auto& triangle : kTriangles) append(bytes += '\3', triangle);
    return bytes;
}

/// Far from its origin, in double precision.
std::string far_ply() {
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty uchar label\nproperty double x\n"
        "property double y\nproperty double z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
    for (const auto& p : kPositions) {
        bytes += '\7';
        for (const float coordinate : p) append(bytes, 1e6 + double(coordinate));
    }
    for (const auto& triangle : kTriangles) append(bytes += '\3', triangle);
    return bytes;
}

std::string stl(bool binary) {
    std::string bytes = binary ? std::string(80, ' ') + std::string("\4\0\0\0", 4) : "solid a\n";
    for (const auto& triangle : kTriangles) {
        bytes += binary ? std::string(12, '\0') : "facet normal 0 0 0\nouter loop\n";
        for (const std::int32_t corner : triangle) {
            const float* p = kPositions[corner];
            for (int k = 0; binary && k < 3; ++k) append(bytes, p[k]);
            if (!binary)
                bytes +=
                    "vertex " + std::to_string(p[0]) + ' ' + std::to_string(p[1]) + ' ' + std::to_string(p[2]) + '\n';
        }
        bytes += binary ? std::string(2, '\0') : "endloop\nendfacet\n";
    }
    return binary ? bytes : bytes + "endsolid a\n";
}

Image small_image(int channels) {
    Image image(24, 12, channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = float(i % 17) / 17.0f;
    return image;
}

std::string image_bytes(const std::string& name, int channels) {
    const TemporaryFolder folder;
    write_image(folder / name, small_image(channels));
    return content_of(folder / name);
}

/// Radiance RGBE, which write_image does not write: scan lines without run lengths.
std::string hdr_bytes() {
    std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 3 +X 6\n";
    for (int i = 0; i < 18; ++i) bytes += std::string("\x60\x70\x50\x81", 4);
    return bytes;
}

GltfBuilder rich_gltf() {
    GltfBuilder b;
    const int position = b.attribute<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, kFloat, "VEC3", 3);
    const int normal = b.attribute<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 3);
    const int texcoord = b.attribute<float>({0, 0, 1, 0, 0, 1, 1, 1}, kFloat, "VEC2", 2);
    const int indices = b.attribute<std::uint16_t>({0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}, kUnsignedShort, "SCALAR", 1);
    b.mesh({{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", texcoord}},
           {{"indices", indices}, {"material", 0}});
    const std::string png = image_bytes("a.png", 3);
    b.root["images"] = {{{"bufferView", b.view(std::vector<char>(png.begin(), png.end()))}, {"mimeType", "image/png"}}};
    b.root["textures"] = {{{"source", 0}}};
    b.root["materials"] = json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions":
        {"KHR_texture_transform": {"scale": [2, 2], "rotation": 0.5}}}}, "extensions": {
        "KHR_materials_transmission": {"transmissionFactor": 1, "transmissionTexture": {"index": 0}},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationColor": [1, 0.5, 1], "attenuationDistance": 2},
        "KHR_materials_ior": {"ior": 1.4}, "KHR_materials_dispersion": {"dispersion": 0.1}}}])");
    b.root["cameras"] =
        json::parse(R"([{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1, "zfar": 10}}])");
    b.node(
        json::parse(R"({"name": "a", "mesh": 0, "rotation": [0, 0, 0, 1], "scale": [1, 2, -1], "children": [1, 2]})"));
    b.node(json::parse(R"({"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1]})"));
    b.node(json::parse(R"({"camera": 0, "translation": [0, 0, 5]})"));
    return b;
}

/// A skinned bar with morph targets, dense and sparse, and every kind of channel.
GltfBuilder animated_gltf() {
    GltfBuilder b = hinged_bar();
    const int up = b.attribute<float>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0}, kFloat, "VEC3", 3);
    const int which = b.view<std::uint8_t>({1, 4});
    const int values = b.view<float>({0, 0, 1, 0, 0, 2});
    const int sparse = b.accessor(-1, kFloat, "VEC3", 6,
                                  {{"sparse",
                                    {{"count", 2},
                                     {"indices", {{"bufferView", which}, {"componentType", kUnsignedByte}}},
                                     {"values", {{"bufferView", values}}}}}});
    b.root["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", up}, {"NORMAL", sparse}}, {{"POSITION", sparse}}};
    b.root["meshes"][0]["weights"] = {0.5, 0};
    b.node({{"mesh", 0}, {"weights", {0, 1}}, {"translation", {3, 0, 0}}});
    b.root["scenes"][0]["nodes"] = {0, 1, 3};
    add_channel(b, 0, "weights", {0, 1, 2}, {0, 0, 1, 0, 1, 1}, "SCALAR", 1, "STEP");
    std::vector<float> spline(18);
    for (std::size_t i = 0; i < spline.size(); ++i) spline[i] = float(i % 5);
    add_channel(b, 1, "translation", {0, 2}, spline, "VEC3", 3, "CUBICSPLINE", 1);
    add_channel(b, 3, "scale", {0, 2}, {1, 1, 1, 2, 3, 4}, "VEC3", 3, "LINEAR", 1);
    return b;
}

/// Instances of a mesh with a converted material, and a second set of texture coordinates.
GltfBuilder instanced_gltf() {
    GltfBuilder b = rich_gltf();
    const int places = b.attribute<float>({0, 0, 0, 5, 0, 0}, kFloat, "VEC3", 3);
    const int turns = b.attribute<std::int16_t>({0, 0, 0, 32767, 0, 32767, 0, 0}, kShort, "VEC4", 4);
    b.root["accessors"][std::size_t(turns)]["normalized"] = true;
    b.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", places},
                                                                                 {"ROTATION", turns}};
    b.root["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] =
        json::parse(R"({"diffuseTexture": {"index": 0}, "specularGlossinessTexture": {"index": 0, "texCoord": 4}})");
    json& attributes = b.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["TEXCOORD_4"] = attributes["TEXCOORD_0"];
    return b;
}

/// Triangles of meshopt.
GltfBuilder meshopt_gltf() {
    GltfBuilder b = GltfBuilder::triangle();
    set_meshopt(b, 0, encoded_vertices(kPositions, 3, 12), 12, 3, "ATTRIBUTES");
    const unsigned indices[] = {0, 1, 2, 2, 1, 0};
    std::vector<unsigned char> encoded(1000);
    encoded.resize(meshopt_encodeIndexBuffer(encoded.data(), encoded.size(), indices, 6));
    const int view = b.view<std::uint16_t>({9, 9, 9, 9, 9, 9});
    set_meshopt(b, view, encoded, 2, 6, "TRIANGLES");
    b.root["meshes"][0]["primitives"][0]["indices"] = b.accessor(view, kUnsignedShort, "SCALAR", 6);
    return b;
}

/// As text, with its buffer inside.
std::string gltf_text(GltfBuilder b) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    b.bin.resize((b.bin.size() + 2) / 3 * 3);
    std::string base64;
    for (std::size_t i = 0; i < b.bin.size(); i += 3) {
        const auto byte = [&](std::size_t k) { return std::uint32_t(static_cast<unsigned char>(b.bin[i + k])); };
        const std::uint32_t word = byte(0) << 16 | byte(1) << 8 | byte(2);
        for (int shift = 18; shift >= 0; shift -= 6) base64 += kDigits[word >> shift & 63u];
    }
    b.root["buffers"] = {{{"byteLength", b.bin.size()}, {"uri", "data:application/octet-stream;base64," + base64}}};
    return b.root.dump();
}

// --- the kinds --------------------------------------------------------------------------------------

TEST(FuzzMeshes, Obj) {
    fuzz("a.obj",
         "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\nusemtl m\ns 1\nf 1/1/1 3/1/1 2/1/1\nf 1 2 4\n"
         "f -3 -2 -1\nf 1//1 4//1 3//1\n",
         load_checked);
}
TEST(FuzzMeshes, ObjUtf16) {
    const std::string text = "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 \\\n2 4\nf 2 3 4\nf -4 -1 -2\n";
    std::string bytes = "\xff\xfe";
    for (const char c : text) bytes += {c, '\0'};
    fuzz("utf16.obj", bytes, load_checked);
}
/// Also polygons of any shape.
TEST(FuzzMeshes, ObjPolygons) {
    fuzz("polygons.obj",
         "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 2 1 0\nv 1 3 0\nv 0 3 0\nv 1 1 2\nf 6 5 4 3 2 1\nf 1 2 7\nf 2 3 4 7\nf 4 5 6 1 "
         "7\n",
         load_checked);
}
TEST(FuzzMeshes, ObjMaterials) {
    const TemporaryFolder images;
    write_image(images / "a.png", small_image(3));
    const std::string texture = (images / "a.png").string();
    fuzz(
        "a.mtl",
        "newmtl a\nKd .5 .4 .3\nKs 1 1 1\nNs 200\nillum 2\nmap_Kd -s 2 2 1 -o 0.5 0 -clamp on " + texture + "\nmap_d " +
            texture + "\nKe 1 0 0\nnewmtl b\nd 0.1\nNi 1.4\nTf 1 .9 .8\nillum 7\nPr 0.2\nTr 0.3\n",
        [](const std::string& file) {
            const std::string obj = file.substr(0, file.size() - 3) + "obj";
            std::ofstream(obj) << "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 1\nusemtl a\n"
                                  "f 1/1 3/2 2/1\nf 1/2 2/1 4/1\nusemtl b\nf 2 3 4\nf 1 4 3\n";
            LoadOptions options;
            options.allow_outside = true;  // the images are in a folder of their own
            EXPECT_EQ(broken_promise(load_scene(obj, options)), "");
        },
        kImageRounds, false);
}
TEST(FuzzMeshes, PlyStrips) {
    std::string bytes =
        "ply\nformat binary_big_endian 1.0\nelement a 1\nproperty list uchar float b\nelement vertex 4\n"
        "property uchar x\nproperty uchar y\nproperty uchar z\nelement tristrips 1\n"
        "property list uchar char vertex_indices\nend_header\n";
    bytes += std::string(1, '\0');
    for (const auto& p : kPositions)
        for (const float coordinate : p) bytes += char(coordinate);
    bytes += std::string("\x0a\0\1\3\2\0\1\xff\0\1\2", 11);
    fuzz("strips.ply", bytes, load_checked);
}
TEST(FuzzMeshes, PlyAscii) { fuzz("ascii.ply", ply(false), load_checked); }
TEST(FuzzMeshes, PlyBinary) { fuzz("binary.ply", ply(true), load_checked); }
TEST(FuzzMeshes, FarPly) { fuzz("far.ply", far_ply(), load_checked); }
TEST(FuzzMeshes, FarObj) {
    fuzz("far.obj",
         "v 1e6 2e6 -3e6 1\nv 1000001 2e6 -3e6 0.5\nv 1e6 2000001 -3e6\nv 1e6 2e6 -2999999.0 0.1 0.2 0.3\n"
         "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n",
         load_checked);
}
TEST(FuzzMeshes, FarOff) {
    fuzz("far.off", "OFF 4 4 6\n1e6 0 0\n1000001 0 0 # far\n1e6 1 0\n1e6 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
         load_checked);
}
TEST(FuzzMeshes, OffAcrossLines) {
    fuzz("across.off",
         "CNOFF 4 4 6\n0 0 0 0 0 1 1 1\n0 1 1 0 0 0\n0 1 1 1 0 1\n0 1 0 0 0 1 0 1 0 1 0 0 1 0 0 1 1 1 1 1\n3 0 2 1 3 0 "
         "1\n3 3 1 2 3 3 0 3 2\n",
         load_checked);
}
TEST(FuzzMeshes, Off) {
    fuzz("a.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n", load_checked);
}
TEST(FuzzMeshes, StlAscii) { fuzz("ascii.stl", stl(false), load_checked); }
TEST(FuzzMeshes, StlBinary) { fuzz("binary.stl", stl(true), load_checked); }
TEST(FuzzMeshes, ThreeDs) {
    const std::filesystem::path cube = glmark2_folder() / "cube.3ds";
    if (!std::filesystem::exists(cube))
        GTEST_SKIP() << "glmark2's cube.3ds is not here; PELLUCID_GLMARK2_MODELS names its folder";
    fuzz("a.3ds", content_of(cube), load_checked);
}
TEST(FuzzGltf, Text) { fuzz("a.gltf", gltf_text(rich_gltf()), load_checked); }
TEST(FuzzGltf, Binary) { fuzz("a.glb", rich_gltf().glb_bytes(), load_checked); }
TEST(FuzzGltf, AnimatedText) { fuzz("animated.gltf", gltf_text(animated_gltf()), load_posed); }
TEST(FuzzGltf, AnimatedBinary) { fuzz("animated.glb", animated_gltf().glb_bytes(), load_posed); }
TEST(FuzzGltf, Instances) { fuzz("instances.gltf", gltf_text(instanced_gltf()), load_checked, kImageRounds); }
TEST(FuzzGltf, Meshopt) { fuzz("meshopt.glb", meshopt_gltf().glb_bytes(), load_checked, kImageRounds); }
TEST(FuzzGltf, Draco) { fuzz("draco.glb", draco_file(draco_square(false)).glb_bytes(), load_checked, kImageRounds); }
TEST(FuzzImages, Png) { fuzz("a.png", image_bytes("a.png", 4), load_image, kImageRounds); }
TEST(FuzzImages, Exr) { fuzz("a.exr", image_bytes("a.exr", 3), load_map, kImageRounds); }
TEST(FuzzImages, Hdr) { fuzz("a.hdr", hdr_bytes(), load_map, kImageRounds); }

}  // namespace
}  // namespace pellucid
