// Normals of mesh files that bring none.
#include "test_files.h"
#include "test_meshes.h"

#include "core/math.h"
#include "scene/mesh_normals.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pellucid {
namespace {

using namespace test;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Share of the triangles' corners whose normal is the triangle's.
double flat_share(const Mesh& mesh) {
    std::size_t flat = 0;
    for (const glm::uvec3& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) flat += glm::dot(mesh.normals[t[k]], face_normal(mesh, t)) > 0.9999f;
    return double(flat) / double(3 * mesh.triangles.size());
}

/// A sphere of radius 1 whose equator has `segments` edges, without normals.
Mesh sphere(int segments, glm::vec3 center = glm::vec3(0.0f)) {
    Mesh mesh;
    mesh.name = "sphere";
    const int rings = segments / 2;
    for (int r = 0; r <= rings; ++r)
        for (int s = 0; s < segments; ++s) {
            const double polar = 0.5 * kTurn * r / rings, azimuth = kTurn * s / segments;
            mesh.positions.push_back(center + glm::vec3(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                                        -std::sin(polar) * std::sin(azimuth)));
            if (r == 0 || r == rings) mesh.positions.back() = center + glm::vec3(0.0f, r == 0 ? 1.0f : -1.0f, 0.0f);
        }
    const auto at = [&](int r, int s) { return unsigned(r * segments + s % segments); };
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < segments; ++s) {
            if (r > 0) mesh.triangles.emplace_back(at(r, s), at(r + 1, s), at(r, s + 1));
            if (r + 1 < rings) mesh.triangles.emplace_back(at(r, s + 1), at(r + 1, s), at(r + 1, s + 1));
        }
    return mesh;
}

/// A closed cylinder of radius 1 about Y with `rings` bands of `segments` quads.
Mesh cylinder(int segments, int rings) {
    Mesh mesh;
    mesh.name = "cylinder";
    for (int r = 0; r <= rings; ++r)
        for (int s = 0; s < segments; ++s)
            mesh.positions.emplace_back(std::cos(kTurn * s / segments), r, -std::sin(kTurn * s / segments));
    const auto at = [&](int r, int s) { return unsigned(r * segments + s % segments); };
    const auto bottom = unsigned(mesh.positions.size()), top = bottom + 1;
    mesh.positions.emplace_back(0.0f, 0.0f, 0.0f);
    mesh.positions.emplace_back(0.0f, float(rings), 0.0f);
    for (int s = 0; s < segments; ++s) {
        for (int r = 0; r < rings; ++r) {
            mesh.triangles.emplace_back(at(r, s), at(r, s + 1), at(r + 1, s + 1));
            mesh.triangles.emplace_back(at(r, s), at(r + 1, s + 1), at(r + 1, s));
        }
        mesh.triangles.emplace_back(bottom, at(0, s + 1), at(0, s));
        mesh.triangles.emplace_back(top, at(rings, s), at(rings, s + 1));
    }
    return mesh;
}

Mesh with_made_normals(Mesh mesh) {
    make_normals(mesh, kCreasesByShell);
    return mesh;
}

std::string obj_of(const Mesh& mesh) {
    std::string text;
    for (const glm::vec3& p : mesh.positions) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    for (const glm::uvec3& t : mesh.triangles) text += fmt::format("f {} {} {}\n", t.x + 1, t.y + 1, t.z + 1);
    return text;
}

TEST(MadeNormals, AnglesOfShellsKeepWhatIsSharp) {
    const Mesh box = with_made_normals(cube());
    EXPECT_EQ(box.positions.size(), 24u);
    EXPECT_EQ(flat_share(box), 1.0);
    for (const int segments : {10, 16, 32}) {
        const Mesh rod = with_made_normals(cylinder(segments, 8));
        EXPECT_EQ(rod.positions.size(), std::size_t(11 * segments + 2)) << "the vertices of both rims are split";
        for (std::size_t v = 0; v < rod.positions.size(); ++v)
            EXPECT_TRUE(std::abs(std::abs(rod.normals[v].y) - 1.0f) < 1e-6f || std::abs(rod.normals[v].y) < 1e-6f);
    }
}

TEST(MadeNormals, CoarseSpheresStaySmooth) {
    for (const int segments : {10, 16, 24, 64}) {
        const Mesh ball = with_made_normals(sphere(segments));
        EXPECT_EQ(ball.positions.size(), sphere(segments).positions.size());
        Mesh smooth = sphere(segments);
        make_normals(smooth, radians_from_degrees(180.0f));
        EXPECT_EQ(ball.normals, smooth.normals);
    }
}

TEST(MadeNormals, EveryShellHasItsOwnAngle) {
    const Mesh both = with_made_normals(joined(sphere(24), cube(1.0f, {4.0f, 0.0f, 0.0f})));
    for (const glm::uvec3& t : both.triangles)
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 p = both.positions[t[k]], n = both.normals[t[k]];
            if (p.x > 2.0f)
                EXPECT_GT(glm::dot(n, face_normal(both, t)), 0.9999f);
            else
                EXPECT_GT(glm::dot(n, p), 0.99f);
        }
}

TEST(MadeNormals, GivenAnglesHold) {
    const TemporaryFolder folder;
    const std::string file = folder.file("cube.obj", obj_of(cube()));
    EXPECT_EQ(load_scene(file).meshes.at(0).positions.size(), 24u);
    LoadOptions options;
    options.crease_angle = radians_from_degrees(100.0f);
    EXPECT_EQ(load_scene(file, options).meshes.at(0).positions.size(), 8u);
    options.crease_angle = 0.0f;
    const Mesh ball = load_scene(folder.file("ball.obj", obj_of(sphere(16))), options).meshes.at(0);
    EXPECT_EQ(flat_share(ball), 1.0);
}

/// Text; `normal` is written for every facet.
std::string stl_of(const Mesh& mesh, const char* normal) {
    std::string text = "solid thing\n";
    for (const glm::uvec3& t : mesh.triangles) {
        text += fmt::format("facet normal {}\nouter loop\n", normal);
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 p = mesh.positions[t[k]];
            text += fmt::format("vertex {} {} {}\n", p.x, p.y, p.z);
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid thing\n";
}

TEST(MadeNormals, FacetsOfStlAreFlatWhateverItsNormalsAre) {
    const TemporaryFolder folder;
    for (const char* normal : {"0 0 0", "1 0 0"}) {
        const Scene scene = load_scene(folder.file("ball.stl", stl_of(sphere(16), normal)));
        EXPECT_EQ(flat_share(scene.meshes.at(0)), 1.0) << normal;
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    }
    LoadOptions options;
    options.crease_angle = radians_from_degrees(60.0f);
    EXPECT_LT(flat_share(load_scene((folder / "ball.stl").string(), options).meshes.at(0)), 0.1);
    LoadOptions remade;
    remade.remake_normals = true;
    EXPECT_LT(flat_share(load_scene((folder / "ball.stl").string(), remade).meshes.at(0)), 0.1);
    EXPECT_EQ(flat_share(load_scene(folder.file("cube.stl", stl_of(cube(), "0 0 0")), remade).meshes.at(0)), 1.0);
}

/// With one normal per vertex, from the origin.
std::string obj_with_normals(const Mesh& mesh, float length) {
    std::string text;
    for (const glm::vec3& p : mesh.positions) {
        const glm::vec3 n = length * glm::normalize(p);
        text += fmt::format("v {} {} {}\nvn {} {} {}\n", p.x, p.y, p.z, n.x, n.y, n.z);
    }
    for (const glm::uvec3& t : mesh.triangles)
        text += fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", t.x + 1, t.y + 1, t.z + 1);
    return text;
}

TEST(MadeNormals, NormalsOfTheFileAreKeptUnlessRemade) {
    const TemporaryFolder folder;
    const std::string file = folder.file("round.obj", obj_with_normals(cube(), 1.0f));
    EXPECT_EQ(flat_share(load_scene(file).meshes.at(0)), 0.0);
    LoadOptions options;
    options.remake_normals = true;
    EXPECT_EQ(flat_share(load_scene(file, options).meshes.at(0)), 1.0);
}

TEST(MadeNormals, NormalsThatAreAllZeroAreNone) {
    const TemporaryFolder folder;
    const Scene scene = load_scene(folder.file("zero.obj", obj_with_normals(cube(), 0.0f)));
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    EXPECT_EQ(flat_share(scene.meshes.at(0)), 1.0);
}

TEST(MadeNormals, ReportedFilesHaveEdges) {
    const std::filesystem::path reports = data_folder() / "reports";
    if (!std::filesystem::exists(reports / "cube-no-normals.obj"))
        GTEST_SKIP() << "PELLUCID_TEST_DATA names no folder with reports/cube-no-normals.obj";
    for (const char* name : {"cube-no-normals.obj", "stl-zero-normals.stl"}) {
        const Scene scene = load_scene((reports / name).string());
        EXPECT_EQ(flat_share(scene.meshes.at(0)), 1.0) << name;
        EXPECT_EQ(scene.warnings.size(), warnings_with(scene, "no such material file")) << name;
    }
}

}  // namespace
}  // namespace pellucid
