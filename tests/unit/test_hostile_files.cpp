// Files that ask for more than a scene may have: memory, depth, or files of others.
#include "core/read_apart.h"
#include "unit/gltf_builder.h"
#include "unit/test_files.h"

#include <pellucid/environment.h>
#include <pellucid/image.h>
#include <pellucid/volume.h>

#include <gtest/gtest.h>

#include <sched.h>
#include <signal.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace pellucid {
namespace {

using namespace test;
namespace fs = std::filesystem;

/// Sets an environment variable for a test.
class Variable {
public:
    Variable(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;
    ~Variable() { unsetenv(name_); }

private:
    const char* name_;
};

bool has(const std::string& text, std::string_view part) { return text.find(part) != text.npos; }

// --- sizes ------------------------------------------------------------------------------------------

TEST(HostileSizes, AnAccessorOfAHundredGigabytesIsRefused) {
    GltfBuilder b = GltfBuilder::triangle();
    b.root["accessors"][0]["count"] = 8'000'000'000;
    const TemporaryFolder folder;
    const std::string error = load_error(folder.file("a.glb", b.glb_bytes()));
    EXPECT_TRUE(has(error, "reach beyond")) << error;
}

TEST(HostileSizes, ASparseAccessorWithoutDataIsRefused) {
    GltfBuilder b = GltfBuilder::triangle();
    const int which = b.view<std::uint8_t>({0});
    const int values = b.view<float>({0, 0, 0});
    b.root["accessors"][0].erase("bufferView");
    b.root["accessors"][0]["count"] = 8'000'000'000;
    b.root["accessors"][0]["sparse"] = {{"count", 1},
                                        {"indices", {{"bufferView", which}, {"componentType", kUnsignedByte}}},
                                        {"values", {{"bufferView", values}}}};
    const TemporaryFolder folder;
    const std::string error = load_error(folder.file("a.glb", b.glb_bytes()));
    EXPECT_TRUE(has(error, "elements without data")) << error;
}

/// One buffer is read by many meshes: a small file, much memory.
TEST(HostileSizes, AGltfFileOfMoreThanItsShareOfMemoryIsRefused) {
    GltfBuilder b = GltfBuilder::triangle();
    const int positions = b.attribute<float>(std::vector<float>(30000, 1.0f), kFloat, "VEC3", 3);
    for (int i = 0; i < 500; ++i)
        b.root["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", positions}}}, {"mode", 4}});
    const TemporaryFolder folder;
    const std::string file = folder.file("a.glb", b.glb_bytes());
    const Variable share("PELLUCID_MEMORY_SHARE", "0.0005");
    const std::string error = load_error(file);
    EXPECT_TRUE(has(error, file)) << error;
    EXPECT_TRUE(has(error, "PELLUCID_MEMORY_SHARE")) << error;
}

TEST(HostileSizes, ManyNodesOfManyPrimitivesAreRefused) {
    GltfBuilder b = GltfBuilder::triangle();
    const json primitive = b.root["meshes"][0]["primitives"][0];
    for (int i = 0; i < 1100; ++i) {
        b.root["meshes"][0]["primitives"].push_back(primitive);
        b.root["nodes"].push_back({{"mesh", 0}});
        b.root["scenes"][0]["nodes"].push_back(i + 1);
    }
    const TemporaryFolder folder;
    const std::string error = load_error(folder.file("a.glb", b.glb_bytes()));
    EXPECT_TRUE(has(error, "objects in the scene")) << error;
}

TEST(HostileSizes, AnObjFileOfMoreThanItsShareOfMemoryIsRefused) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < 100000; ++i) text += "f 1 2 3\n";
    const TemporaryFolder folder;
    const std::string file = folder.file("a.obj", text);
    const Variable share("PELLUCID_MEMORY_SHARE", "0.0005");
    EXPECT_TRUE(has(load_error(file), "PELLUCID_MEMORY_SHARE"));
}

TEST(HostileSizes, AnImageOfMoreThanTheShareOfMemoryRefusesTheScene) {
    const TemporaryFolder folder;
    write_image(folder / "a.png", Image(2000, 2000, 4));
    const std::string file =
        folder.file("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
    folder.file("a.mtl", "newmtl a\nKd 1 1 1\nmap_Kd a.png\n");
    EXPECT_EQ(load_error(file), "");
    const Variable share("PELLUCID_MEMORY_SHARE", "0.001");
    EXPECT_TRUE(has(load_error(file), "PELLUCID_MEMORY_SHARE")) << load_error(file);
}

TEST(HostileSizes, AShareOfMemoryIsANumber) {
    const TemporaryFolder folder;
    const std::string file = folder.file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (const char* value : {"0", "-1", "all", "101", "0.5 "}) {
        const Variable share("PELLUCID_MEMORY_SHARE", value);
        EXPECT_TRUE(has(load_error(file), "PELLUCID_MEMORY_SHARE=")) << value;
    }
}

TEST(HostileSizes, CountsThatAFileCannotHoldAreRefused) {
    const TemporaryFolder folder;
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n";
    EXPECT_TRUE(has(load_error(folder.file("a.ply", ply)), "in a file of"));
    EXPECT_TRUE(has(load_error(folder.file("a.off", "OFF\n99999999999 1 0\n0 0 0\n")), "in a file of"));
    EXPECT_TRUE(has(load_error(folder.file("a.stl", std::string(80, ' ') + "\xff\xff\xff\x7f" + std::string(50, '\0'))),
                    "announces"));
}

TEST(HostileSizes, ImagesOfAMillionByAMillionPixelsAreRefused) {
    const TemporaryFolder folder;
    const std::string hdr = folder.file("a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000000 +X 1000000\n\1\1");
    EXPECT_THROW(load_environment(hdr), Error);
    write_image(folder / "b.exr", Image(4, 4, 3));
    std::string exr = content_of(folder / "b.exr");
    const std::int32_t million = 1'000'000;
    for (const char* window : {"dataWindow", "displayWindow"})
        for (const int corner : {8, 12})
            std::memcpy(&exr[exr.find(window) + std::string_view(window).size() + 1 + 6 + 4 + std::size_t(corner)],
                        &million, 4);
    EXPECT_THROW(load_environment(folder.file("a.exr", exr)), Error);
}

// --- depth ------------------------------------------------------------------------------------------

TEST(HostileDepth, JsonOfDepthAHundredThousandIsRefused) {
    const TemporaryFolder folder;
    const std::string deep = R"({"asset":{"version":"2.0"},"extras":)" + std::string(100000, '[');
    EXPECT_TRUE(has(load_error(folder.file("a.gltf", deep)), "nested too deeply"));
}

TEST(HostileDepth, NodesOfDepthAHundredThousandAreRead) {
    GltfBuilder b = GltfBuilder::triangle();
    constexpr int kDepth = 100000;
    b.root["nodes"] = json::array();
    for (int i = 0; i < kDepth; ++i) b.root["nodes"].push_back({{"children", {i + 1}}});
    b.root["nodes"].push_back({{"mesh", 0}});
    const TemporaryFolder folder;
    EXPECT_EQ(load_error(folder.file("a.glb", b.glb_bytes())), "");
}

TEST(HostileDepth, NodesInACircleAreRefused) {
    GltfBuilder b = GltfBuilder::triangle();
    b.root["nodes"] = {{{"children", {1}}}, {{"children", {0}}, {"mesh", 0}}};
    const TemporaryFolder folder;
    EXPECT_TRUE(has(load_error(folder.file("a.glb", b.glb_bytes())), "its own ancestor"));
}

// --- files of others --------------------------------------------------------------------------------

/// A folder with a scene's folder in it, and files beside that.
struct Outside : testing::Test {
    Outside() {
        allowed.allow_outside = true;
        fs::create_directory(folder / "scene");
        buffer.assign(36, '\0');
        const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
        std::memcpy(buffer.data(), corners, sizeof corners);
        folder.file("b.bin", buffer);
        write_image(folder / "a.png", Image(4, 4, 3));
        folder.file("m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd a.png\n");
        fs::create_symlink("../b.bin", folder / "scene/link.bin");
        fs::create_symlink("..", folder / "scene/up");
    }

    std::string gltf(const std::string& buffer_uri, const std::string& image_uri) const {
        GltfBuilder b = GltfBuilder::triangle();
        b.root["buffers"] = {{{"byteLength", 36}, {"uri", buffer_uri}}};
        b.root["bufferViews"] = {{{"buffer", 0}, {"byteLength", 36}}};
        b.root["accessors"] = {{{"bufferView", 0}, {"componentType", kFloat}, {"type", "VEC3"}, {"count", 3}}};
        b.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"material", 0}}}}}};
        b.root["images"] = {{{"uri", image_uri}}};
        b.root["textures"] = {{{"source", 0}}};
        b.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
        return folder.file("scene/a.gltf", b.root.dump());
    }

    std::string obj(const std::string& library) const {
        return folder.file("scene/a.obj",
                           "mtllib " + library + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
    }

    TemporaryFolder folder;
    std::string buffer;
    LoadOptions allowed;
};

TEST_F(Outside, ABufferThereIsRefusedByName) {
    folder.file("scene/b.bin", buffer);
    EXPECT_EQ(load_error(gltf("b.bin", "data:,")), "");
    for (const std::string& uri : {std::string("../b.bin"), (folder / "b.bin").string(), std::string("%2e%2e/b.bin"),
                                   std::string("%2E%2E%2Fb.bin"), std::string("..\\b.bin"), std::string("link.bin"),
                                   std::string("up/b.bin"), std::string("x/../../b.bin")}) {
        const std::string error = load_error(gltf(uri, "data:,"));
        EXPECT_TRUE(has(error, "outside") && has(error, "--allow-outside") && has(error, ".bin"))
            << uri << ": " << error;
        if (uri == "x/../../b.bin") continue;  // there is no folder x
        EXPECT_EQ(load_error(gltf(uri, "data:,"), allowed), "") << uri;
    }
}

TEST_F(Outside, AnImageThereIsLeftOutWithAWarning) {
    folder.file("scene/b.bin", buffer);
    for (const std::string& uri :
         {std::string("../a.png"), (folder / "a.png").string(), std::string("%2e%2e/a.png"), std::string("up/a.png")}) {
        const Scene scene = load_scene(gltf("b.bin", uri));
        EXPECT_EQ(warnings_with(scene, "--allow-outside"), 1u) << uri;
        EXPECT_TRUE(scene.images.empty()) << uri;
        const Scene whole = load_scene(gltf("b.bin", uri), allowed);
        EXPECT_EQ(whole.images.size(), 1u) << uri;
        EXPECT_EQ(warnings_with(whole, "outside"), 0u) << uri;
    }
}

TEST_F(Outside, AMaterialLibraryThereIsRefusedByName) {
    for (const std::string& name : {std::string("../m.mtl"), (folder / "m.mtl").string(), std::string("up/m.mtl")}) {
        const std::string error = load_error(obj(name));
        EXPECT_TRUE(has(error, "m.mtl") && has(error, "--allow-outside")) << name << ": " << error;
        EXPECT_EQ(load_scene(obj(name), allowed).images.size(), 1u) << name;
    }
    // A path from another computer, of which the name counts.
    EXPECT_EQ(load_error(obj("/home/nobody/here/n.mtl")), "");
    folder.file("scene/m.mtl", "newmtl a\nKd 1 1 1\n");
    EXPECT_EQ(load_error(obj((folder / "m.mtl").string())), "");
}

TEST_F(Outside, ATextureOfAnObjFileThereIsLeftOutWithAWarning) {
    folder.file("scene/m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd ../a.png\n");
    const Scene scene = load_scene(obj("m.mtl"));
    EXPECT_EQ(warnings_with(scene, "--allow-outside"), 1u);
    EXPECT_TRUE(scene.images.empty());
    EXPECT_EQ(load_scene(obj("m.mtl"), allowed).images.size(), 1u);
}

TEST_F(Outside, ATextureInAnotherFolderOfTheSceneIsRead) {
    fs::create_directory(folder / "scene/materials");
    fs::create_directory(folder / "scene/textures");
    fs::copy_file(folder / "a.png", folder / "scene/textures/a.png");
    folder.file("scene/materials/m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd ../textures/a.png\n");
    EXPECT_EQ(load_scene(obj("materials/m.mtl")).images.size(), 1u);
}

TEST_F(Outside, AVolumeThereIsRefusedByName) {
    save_volume(folder / "v.vdb", make_volume("luneburg"));
    GltfBuilder b = GltfBuilder::triangle();
    b.root["nodes"][0]["extras"]["pellucid_volume"] = "../v.vdb";
    const std::string file = folder.file("scene/a.glb", b.glb_bytes());
    const std::string error = load_error(file);
    EXPECT_TRUE(has(error, "v.vdb") && has(error, "--allow-outside")) << error;
    EXPECT_EQ(load_error(file, allowed), "");
}

// --- the program that reads -------------------------------------------------------------------------

/// Reads by tests/unit/failing_reader.cpp.
std::string failure_of(const std::string& how, std::uint64_t most_bytes = 1 << 20) {
    static ReaderProgram program(fs::read_symlink("/proc/self/exe").parent_path() / "failing_reader");
    try {
        const auto request = std::as_bytes(std::span(how));
        const std::vector<std::byte> answer = program.read(ApartKind::kImage, request, most_bytes, "a.png");
        return std::string(reinterpret_cast<const char*>(answer.data()), answer.size());
    } catch (const Error& error) {
        return std::string("Error: ") + error.what();
    }
}

TEST(ReadApart, ACrashIsAnErrorAndTheNextFileIsRead) {
    EXPECT_EQ(failure_of("echo"), "echo");
    for (const char* how : {"crash", "abort", "exit"}) {
        const std::string failure = failure_of(how);
        EXPECT_TRUE(has(failure, "Error: a.png: its reader crashed")) << how << ": " << failure;
        EXPECT_EQ(failure_of("echo"), "echo");
    }
}

TEST(ReadApart, WhatTheReaderThrowsIsTheError) { EXPECT_EQ(failure_of("throw"), "Error: a.png: is bad"); }

TEST(ReadApart, TooMuchMemoryIsAnError) {
    EXPECT_EQ(failure_of("memory"), "Error: a.png: needs more memory than a scene may take");
    EXPECT_EQ(failure_of("large"), "Error: a.png: needs more memory than a scene may take");
}

TEST(ReadApart, AProgramThatEndedIsStartedAgain) {
    EXPECT_EQ(failure_of("echo"), "echo");
    EXPECT_TRUE(has(failure_of("kill"), "crashed"));
    EXPECT_EQ(failure_of("echo"), "echo");
}

TEST(ReadApart, TheProgramEndsWithItsUser) {
    const std::string file = fs::read_symlink("/proc/self/exe").parent_path() / "failing_reader";
    pid_t pid = 0;
    {
        ReaderProgram program(file);
        const std::vector<std::byte> answer =
            program.read(ApartKind::kImage, std::as_bytes(std::span(std::string_view("pid"))), 1 << 20, "a.png");
        std::memcpy(&pid, answer.data(), sizeof pid);
        EXPECT_EQ(kill(pid, 0), 0);
    }
    for (int i = 0; i < 10'000'000 && kill(pid, 0) == 0; ++i) sched_yield();
    EXPECT_NE(kill(pid, 0), 0) << "is still there";
}

TEST(ReadApart, AMissingProgramIsAnError) {
    ReaderProgram program("/no/such/program");
    EXPECT_THROW(program.read(ApartKind::kImage, {}, 1, "a.png"), Error);
}

}  // namespace
}  // namespace pellucid
