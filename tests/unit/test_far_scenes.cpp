// A translation of a whole scene changes nothing but Scene::origin.
#include "animated_gltf.h"
#include "test_meshes.h"

#include "scene/far_positions.h"

#include <pellucid/animation.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace pellucid {
namespace {

using namespace test;

const glm::dvec3 kDirection(1.0, -0.3, 0.7);
constexpr double kOffsets[] = {1e3, 1e6};

/// Floats of a few metres, rounded a few times.
constexpr double kRounding = 2e-6;

json numbers(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// Adds a cube mesh with 8 vertices; returns the attributes' indices as a primitive.
void add_cube(GltfBuilder& b, glm::vec3 center = glm::vec3(0.0f)) {
    const Mesh solid = cube(1.0f, center);
    std::vector<float> positions;
    std::vector<std::uint16_t> indices;
    for (const glm::vec3& p : solid.positions) positions.insert(positions.end(), {p.x, p.y, p.z});
    for (const glm::uvec3& t : solid.triangles)
        indices.insert(indices.end(), {std::uint16_t(t.x), std::uint16_t(t.y), std::uint16_t(t.z)});
    const int position = b.attribute(positions, kFloat, "VEC3", 3);
    b.mesh({{"POSITION", position}}, {{"indices", b.attribute(indices, kUnsignedShort, "SCALAR", 1)}});
}

/// Two cubes, one of them a child that an animation slides, a camera, a lamp, a sun and a volume, all below a node at
/// `offset`.
GltfBuilder everything_at(const glm::dvec3& offset) {
    GltfBuilder b;
    add_cube(b);
    b.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.01}}}}};
    b.root["extensionsUsed"] = {"KHR_lights_punctual"};
    b.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}, {{"type", "directional"}}};
    const auto light = [](int number) { return json{{"KHR_lights_punctual", {{"light", number}}}}; };
    b.node({{"translation", numbers(offset)}, {"children", {1, 3, 4, 5, 6}}});
    b.node({{"mesh", 0}, {"rotation", {0, 0, kHalfRoot, kHalfRoot}}, {"children", {2}}});
    b.node({{"mesh", 0}, {"translation", {0.7, 0.1, 0.3}}, {"scale", {0.5, 0.3, -0.2}}});
    b.node({{"camera", 0}, {"translation", {0.4, 0.6, 3.4}}, {"rotation", {0, kHalfRoot, 0, kHalfRoot}}});
    b.node({{"extensions", light(0)}, {"translation", {0.1, 2.2, 0.3}}});
    b.node({{"extensions", light(1)}, {"rotation", {kHalfRoot, 0, 0, kHalfRoot}}});
    b.node({{"extras", {{"pellucid_volume", "volume:luneburg,resolution=8"}}}, {"translation", {0.2, 0.4, 0.8}}});
    add_channel(b, 2, "translation", {0, 2}, {0.7f, 0.1f, 0.3f, 1.5f, 0.2f, 0.9f}, "VEC3", 3);
    return b;
}

void expect_same(const glm::dmat4& a, const glm::dmat4& b, const std::string& what) {
    for (int c = 0; c < 4; ++c)
        EXPECT_LT(glm::length(a[c] - b[c]), kRounding) << what << ", column " << c << " of a matrix";
}

/// Places both scenes before their cameras.
void expect_same_view(const Scene& scene, const Scene& twin) {
    ASSERT_EQ(scene.cameras.size(), 1u);
    ASSERT_EQ(twin.objects.size(), scene.objects.size());
    const auto view = [](const Scene& s) { return glm::inverse(glm::dmat4(s.cameras.at(0).world_from_view)); };
    const glm::dmat4 here = view(scene), there = view(twin);
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
        expect_same(here * glm::dmat4(scene.objects[i].world_from_object),
                    there * glm::dmat4(twin.objects[i].world_from_object), scene.objects[i].name);
    for (std::size_t i = 0; i < scene.volume_objects.size(); ++i)
        expect_same(here * glm::dmat4(scene.volume_objects[i].world_from_volume),
                    there * glm::dmat4(twin.volume_objects.at(i).world_from_volume), "volume");
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const Light &a = scene.lights[i], &b = twin.lights.at(i);
        EXPECT_EQ(a.direction, b.direction);
        const glm::dvec4 p = here * glm::dvec4(a.position, 1.0) - there * glm::dvec4(b.position, 1.0);
        if (a.kind == Light::Kind::kPoint) {
            EXPECT_LT(glm::length(p), kRounding);
        }
    }
}

TEST(FarScenes, NodesCamerasLightsAndVolumesKeepTheirPrecision) {
    GltfBuilder near = everything_at(glm::dvec3(0.0));
    const Scene scene = load(near);
    EXPECT_EQ(scene.origin, glm::dvec3(0.0));
    ASSERT_EQ(scene.objects.size(), 2u);
    ASSERT_EQ(scene.lights.size(), 2u);
    ASSERT_EQ(scene.volume_objects.size(), 1u);
    for (const double offset : kOffsets) {
        SCOPED_TRACE(offset);
        const glm::dvec3 moved = offset * kDirection;
        GltfBuilder far = everything_at(moved);
        const Scene twin = load(far);
        EXPECT_TRUE(twin.warnings.empty());
        EXPECT_LT(glm::length(twin.origin - moved), 4.0);
        EXPECT_LT(glm::length(scene_bounds(twin).center), 4.0f);
        expect_same_view(scene, twin);
        const glm::dvec3 camera = glm::dvec3(twin.cameras.at(0).world_from_view[3]) + twin.origin;
        EXPECT_LT(glm::length(camera - moved - glm::dvec3(0.4, 0.6, 3.4)), kRounding);
    }
}

TEST(FarScenes, PosesShareTheFrame) {
    GltfBuilder near = everything_at(glm::dvec3(0.0)), far = everything_at(1e6 * kDirection);
    const Scene scene = load(near), twin = load(far);
    for (const double time : {0.0, 1.0, 2.0}) {
        const auto posed = [&](const Scene& rest) {
            Scene result = rest;
            for (const PosedObject& object : pose_at(rest, 0, time).objects)
                result.objects.at(std::size_t(object.object)).world_from_object = object.world_from_object;
            return result;
        };
        expect_same_view(posed(scene), posed(twin));
    }
    EXPECT_EQ(pose_at(twin, 0, 0.0).objects.at(0).world_from_object, twin.objects.at(1).world_from_object);
}

TEST(FarScenes, SkinsArePosedInDoublePrecision) {
    GltfBuilder near = hinged_bar(), far = hinged_bar();
    const glm::dvec3 moved = 1e6 * kDirection;
    far.root["nodes"][1]["translation"] = numbers(moved);
    const Scene scene = load(near), twin = load(far);
    EXPECT_EQ(scene.origin, glm::dvec3(0.0));
    EXPECT_LT(glm::length(twin.origin - moved), 4.0);
    const auto expect_vertices = [&](const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t v = 0; v < a.size(); ++v)
            EXPECT_LT(glm::length(glm::dvec3(b[v]) + (twin.origin - moved) - glm::dvec3(a[v])), kRounding);
    };
    expect_vertices(scene.meshes.at(0).positions, twin.meshes.at(0).positions);
    for (const double time : {1.0, 2.0, 3.0})
        expect_vertices(pose_at(scene, 0, time).meshes.at(0).positions, pose_at(twin, 0, time).meshes.at(0).positions);
}

TEST(FarScenes, OrdinaryScenesAreNotMoved) {
    GltfBuilder b;
    add_cube(b);
    b.node({{"mesh", 0}, {"translation", {6.9, -6.9, 0.0}}});  // the radius is 0.866
    const Scene scene = load(b);
    EXPECT_EQ(scene.origin, glm::dvec3(0.0));
    EXPECT_EQ(scene.objects.at(0).world_from_object[3], glm::vec4(6.9f, -6.9f, 0.0f, 1.0f));
    b.root["nodes"][0]["translation"] = {6.95, -6.9, 0.0};
    EXPECT_EQ(load(b).origin, glm::dvec3(7.0, 0.0, 0.0)) << "each axis by itself, in multiples of half a metre";
}

TEST(FarScenes, VerticesBakedFarAwayAreWarnedAboutOnce) {
    const glm::vec3 center(1000.0f, 0.0f, -2000.0f);
    GltfBuilder b;
    add_cube(b, center);
    add_cube(b);
    b.node({{"mesh", 0}, {"name", "baked"}, {"scale", {2, 2, 2}}});
    b.node({{"mesh", 1}, {"translation", {2000, 0, -4000}}});
    b.root["scenes"][0]["nodes"] = {0, 1};
    b.root["meshes"][0]["name"] = "body";
    b.root["meshes"][0]["primitives"][0].erase("material");
    const Scene scene = load(b);
    EXPECT_EQ(warnings_with(scene,
                            "body: vertices are stored as 32-bit numbers 4.47e+03 m from their origin, where "
                            "these are 0.00024 m apart"),
              1u);
    EXPECT_EQ(scene.warnings.size(), 1u);
    EXPECT_LT(glm::length(scene.origin - glm::dvec3(2000.0, 0.0, -4000.0)), 3.0);
    // No vertex moves by this.
    const Mesh& mesh = scene.meshes.at(std::size_t(scene.objects.at(0).mesh));
    Box box;
    for (const glm::vec3& p : mesh.positions) {
        EXPECT_LT(glm::length(p), 3.0f);
        box.add(glm::dvec3(scene.objects[0].world_from_object * glm::vec4(p, 1.0f)) + scene.origin);
    }
    EXPECT_EQ(box.low, glm::dvec3(1999.0, -1.0, -4001.0));
    EXPECT_EQ(box.high, glm::dvec3(2001.0, 1.0, -3999.0));
}

TEST(FarScenes, SmallPartsOfOrdinaryScenesAreNotWarnedAbout) {
    GltfBuilder b;
    add_cube(b);
    add_cube(b, glm::vec3(40.0f, 0.0f, 0.0f));  // 40 times its size away, in a scene that is as large
    b.node({{"mesh", 0}, {"scale", {80, 80, 80}}});
    b.node({{"mesh", 1}});
    b.root["scenes"][0]["nodes"] = {0, 1};
    EXPECT_TRUE(load(b).warnings.empty());
}

// --- mesh files -------------------------------------------------------------------------------------

using Positions = std::vector<glm::dvec3>;

Positions cube_at(const glm::dvec3& offset) {
    Positions positions;
    for (const glm::vec3& p : cube().positions) positions.push_back(glm::dvec3(p) + offset);
    return positions;
}

std::string obj(const Positions& positions, const char* w = "") {
    std::string text = "# v 1 2 3\no cube\n";
    for (const glm::dvec3& p : positions) text += fmt::format("v {:.17g}\t{:.17g} {:+.17g}{}\r\n", p.x, p.y, p.z, w);
    for (const glm::uvec3& t : cube().triangles) text += fmt::format("f {} {} {}\n", t.x + 1, t.y + 1, t.z + 1);
    return text;
}

std::string off(const Positions& positions) {
    std::string text = "OFF # v\n\n8 12 0\n# far\n";
    for (const glm::dvec3& p : positions) text += fmt::format(" {:.17g} {:.17g} {:.17g} # far\n", p.x, p.y, p.z);
    for (const glm::uvec3& t : cube().triangles) text += fmt::format("3 {} {} {}\n", t.x, t.y, t.z);
    return text;
}

std::string stl(const Positions& positions) {
    std::string text = "solid cube\n";
    for (const glm::uvec3& t : cube().triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3& p = positions[t[k]];
            text += fmt::format("  vertex {:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z);
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid cube\n";
}

/// Of 64-bit numbers, with another property before the coordinates and one after them.
std::string ply(const Positions& positions, const std::string& format) {
    std::string text = fmt::format(
        "ply\nformat {} 1.0\nelement vertex 8\nproperty uchar label\nproperty double x\nproperty double y\nproperty "
        "double z\nproperty float quality\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n",
        format);
    const bool ascii = format == "ascii";
    const auto put = [&](auto value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        if (format == "binary_big_endian") std::reverse(raw, raw + sizeof value);
        text.append(raw, sizeof value);
    };
    for (const glm::dvec3& p : positions) {
        if (ascii) text += fmt::format("7 {:.17g} {:.17g} {:.17g} 0.5\n", p.x, p.y, p.z);
        if (ascii) continue;
        put(std::uint8_t(7));
        for (int k = 0; k < 3; ++k) put(p[k]);
        put(0.5f);
    }
    for (const glm::uvec3& t : cube().triangles) {
        if (ascii) text += fmt::format("3 {} {} {}\n", t.x, t.y, t.z);
        if (ascii) continue;
        put(std::uint8_t(3));
        for (int k = 0; k < 3; ++k) put(std::int32_t(t[k]));
    }
    return text;
}

/// Corners of the scene's only mesh in the file's world.
Box world_box(const Scene& scene) {
    const Mesh& mesh = scene.meshes.at(0);
    Box box = box_of(mesh.positions);
    box.low += scene.origin;
    box.high += scene.origin;
    return box;
}

TEST(FarScenes, TextAndDoublesOfMeshFilesKeepTheirPrecision) {
    const TemporaryFolder folder;
    const glm::dvec3 offset(1e6 + 0.125, -2e6 - 0.3, 0.25);
    const Positions positions = cube_at(offset);
    const std::pair<const char*, std::string> files[] = {
        {"a.obj", obj(positions)},
        {"a.off", off(positions)},
        {"a.stl", stl(positions)},
        {"ascii.ply", ply(positions, "ascii")},
        {"little.ply", ply(positions, "binary_little_endian")},
        {"big.ply", ply(positions, "binary_big_endian")},
    };
    for (const auto& [name, content] : files) {
        SCOPED_TRACE(name);
        const Scene scene = load_scene(folder.file(name, content));
        EXPECT_EQ(broken_promise(scene), "");
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
        EXPECT_EQ(scene.triangle_count(), 12u);
        EXPECT_EQ(scene.origin, glm::dvec3(1e6, -2e6 - 0.5, 0.0)) << "in multiples of half a metre";
        const Box box = world_box(scene);
        EXPECT_LT(glm::length(box.low - (offset - 0.5)), 1e-6);
        EXPECT_LT(glm::length(box.high - (offset + 0.5)), 1e-6);
    }
}

TEST(FarScenes, NearMeshFilesAreNotMoved) {
    const TemporaryFolder folder;
    const Positions positions = cube_at({1.5, -2.25, 3.5});
    const std::pair<const char*, std::string> files[] = {{"a.obj", obj(positions)},
                                                         {"a.off", off(positions)},
                                                         {"a.stl", stl(positions)},
                                                         {"a.ply", ply(positions, "ascii")},
                                                         {"b.ply", ply(positions, "binary_big_endian")}};
    for (const auto& [name, content] : files) {
        SCOPED_TRACE(name);
        const Scene scene = load_scene(folder.file(name, content));
        EXPECT_EQ(scene.origin, glm::dvec3(0.0));
        EXPECT_EQ(world_box(scene).low, glm::dvec3(1.0, -2.75, 3.0));
    }
}

TEST(FarScenes, FloatsOfMeshFilesAreWarnedAbout) {
    const TemporaryFolder folder;
    std::string file =
        "ply\nformat binary_little_endian 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
        "property float z\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n";
    for (const glm::dvec3& p : cube_at({1000.0, 0.0, 0.0})) {
        const glm::vec3 rounded(p);
        file.append(reinterpret_cast<const char*>(&rounded.x), sizeof rounded);
    }
    for (const glm::uvec3& t : cube().triangles) {
        file += '\3';
        file.append(reinterpret_cast<const char*>(&t.x), sizeof t);
    }
    const Scene scene = load_scene(folder.file("floats.ply", file));
    EXPECT_EQ(warnings_with(scene,
                            "floats: vertices are stored as 32-bit numbers 1e+03 m from their origin, where "
                            "these are 6.1e-05 m apart: surfaces are that coarse"),
              1u);
    EXPECT_EQ(scene.origin, glm::dvec3(1000.0, 0.0, 0.0));
    EXPECT_EQ(world_box(scene).low, glm::dvec3(999.5, -0.5, -0.5));
}

TEST(FarScenes, PositionsOfObjAreNotDividedByTheirWeight) {
    const TemporaryFolder folder;
    for (const char* w : {" 0.5", " 0", " 2 "}) {
        for (const double offset : {0.0, 1e6}) {
            const Scene scene = load_scene(folder.file("w.obj", obj(cube_at(glm::dvec3(offset)), w)));
            EXPECT_EQ(world_box(scene).low, glm::dvec3(offset - 0.5)) << w;
            EXPECT_EQ(world_box(scene).high, glm::dvec3(offset + 0.5)) << w;
        }
    }
    const Scene colors = load_scene(folder.file("color.obj", obj(cube_at(glm::dvec3(0.0)), " 0.1 0.2 0.3")));
    EXPECT_EQ(world_box(colors).high, glm::dvec3(0.5));
}

TEST(FarScenes, TextThatIsNotUnderstoodIsLeftToTheReader) {
    const TemporaryFolder folder;
    std::string text = obj(cube_at(glm::dvec3(1e6)));
    EXPECT_NE(load_error(folder.file("nan.obj", "v nan 1 2\n" + text)), "");
    EXPECT_NO_THROW(
        load_scene(folder.file("name.stl", "solid vertex of doom\n" + stl(cube_at(glm::dvec3(1e6))).substr(11))));
}

TEST(FarScenes, ReportedScenesAreSeenAlike) {
    const std::filesystem::path reports = data_folder() / "reports";
    if (!std::filesystem::exists(reports / "13-offset-x10000.glb"))
        GTEST_SKIP() << "PELLUCID_TEST_DATA names no folder with reports/13-offset-x10000.glb";
    const Scene scene = load_scene((reports / "13-offset-x1000.glb").string());
    const Scene twin = load_scene((reports / "13-offset-x10000.glb").string());
    EXPECT_EQ(scene.origin, glm::dvec3(1000.0, 0.0, 1000.0));
    EXPECT_EQ(twin.origin, glm::dvec3(10000.0, 0.0, 10000.0));
    expect_same_view(scene, twin);
    const Scene weights = load_scene((reports / "obj-v-with-w.obj").string());
    EXPECT_EQ(world_box(weights).low, glm::dvec3(0.0));
    EXPECT_EQ(world_box(weights).high, glm::dvec3(2.0));
}

}  // namespace
}  // namespace pellucid
