#include "core/math.h"
#include "scene/mesh_normals.h"
#include "scene/mesh_repair.h"
#include "test_meshes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pellucid {
namespace {

using test::cube;
using test::face_normal;
using test::joined;
using test::unwelded;

EdgeCounts edges_of(const Mesh& mesh) { return count_edges(mesh.triangles, weld_positions(mesh.positions)); }

std::vector<std::string> repair(Mesh& mesh, bool make_normals = true) {
    Warnings warnings;
    MeshOrigin origin;
    origin.refractive = true;
    origin.make_normals = make_normals;
    repair_mesh(mesh, origin, warnings);
    return warnings.lines();
}

TEST(MeshRepair, WeldsEqualPositionsOnly) {
    const std::vector<glm::vec3> positions = {
        {0, 0, 0}, {1, 2, 3}, {-0.0f, 0, 0}, {1, 2, 3}, {1, 2, std::nextafter(3.0f, 4.0f)}};
    EXPECT_EQ(weld_positions(positions), (std::vector<std::uint32_t>{0, 1, 0, 1, 4}));
    EXPECT_TRUE(weld_positions({}).empty());
}

TEST(MeshRepair, ClosedWhateverTheVertexSplit) {
    EXPECT_TRUE(edges_of(cube()).closed());
    EXPECT_TRUE(edges_of(unwelded(cube())).closed());
}

TEST(MeshRepair, CountsBoundaryNonManifoldAndMiswoundEdges) {
    Mesh open = cube();
    open.triangles.pop_back();
    EXPECT_EQ(edges_of(open).boundary, 3u);
    EXPECT_EQ(edges_of(open).non_manifold, 0u);

    Mesh fin = cube();
    fin.positions.push_back({0, 3, 0});
    fin.triangles.push_back({fin.triangles[0].x, fin.triangles[0].y, 8});
    EXPECT_EQ(edges_of(fin).boundary, 2u);
    EXPECT_EQ(edges_of(fin).non_manifold, 1u);

    Mesh flipped = cube();
    std::swap(flipped.triangles[3].x, flipped.triangles[3].y);
    EXPECT_EQ(edges_of(flipped).boundary, 0u);
    EXPECT_EQ(edges_of(flipped).miswound, 3u);

    open.name = "open";
    EXPECT_EQ(repair(open), (std::vector<std::string>{"open: 3 boundary edges, 0 non-manifold edges: not a closed "
                                                      "solid, refraction there is approximate"}));
}

TEST(MeshRepair, JoinsVerticesThatAgreeInAllAttributes) {
    Mesh mesh = unwelded(cube());
    join_identical_vertices(mesh);
    EXPECT_EQ(mesh.positions.size(), 8u);
    EXPECT_EQ(mesh.triangles.size(), 12u);

    Mesh flat = unwelded(cube());
    make_normals(flat, 0.0f);
    join_identical_vertices(flat);
    EXPECT_EQ(flat.positions.size(), 24u) << "normals keep the sides apart";
}

TEST(MeshRepair, DropsUnusedVertices) {
    Mesh mesh = cube();
    mesh.positions.push_back({100, 100, 100});
    EXPECT_TRUE(repair(mesh).empty());
    EXPECT_EQ(mesh.positions.size(), 8u);
}

TEST(MeshRepair, DropsTrianglesWithoutArea) {
    Mesh mesh = cube();
    mesh.triangles.push_back({0, 0, 1});
    mesh.triangles.push_back({2, 2, 2});
    EXPECT_EQ(repair(mesh), (std::vector<std::string>{"cube: 2 triangles without area left out"}));
    EXPECT_EQ(mesh.triangles.size(), 12u);
}

TEST(MeshRepair, TriangleSqueezedToALineIsNoHole) {
    // One side's diagonal gets a vertex in its middle; a triangle without area closes the seam.
    Mesh mesh = cube();
    const glm::uvec3 t = mesh.triangles[0];  // shares edge z-x with triangles[1]
    mesh.positions.push_back(0.5f * (mesh.positions[t.z] + mesh.positions[t.x]));
    mesh.triangles[0] = {t.x, t.y, 8};
    mesh.triangles.push_back({t.y, t.z, 8});
    mesh.triangles.push_back({t.z, t.x, 8});
    EXPECT_EQ(repair(mesh), (std::vector<std::string>{"cube: 1 triangle without area left out"}));
}

TEST(MeshRepair, TinyTrianglesAreNotZero) {
    Mesh mesh = cube(1e-12f);
    EXPECT_TRUE(repair(mesh).empty());
    EXPECT_EQ(mesh.triangles.size(), 12u);
}

TEST(MeshRepair, VolumeIsSignedAndIndependentOfPlace) {
    EXPECT_NEAR(signed_volume(cube(2.0f)).value, 8.0, 1e-6);
    EXPECT_NEAR(signed_volume(cube(2.0f, {50, -70, 20})).value, 8.0, 1e-3);
    EXPECT_TRUE(signed_volume(cube()).meaningful());
    Mesh inverted = cube();
    turn_inside_out(inverted);
    EXPECT_NEAR(signed_volume(inverted).value, -1.0, 1e-6);
    EXPECT_FALSE(signed_volume(Mesh()).meaningful());
}

TEST(MeshRepair, TurnsWhatIsInsideOut) {
    Mesh mesh = cube();
    turn_inside_out(mesh);
    EXPECT_EQ(repair(mesh), (std::vector<std::string>{"cube: was wound inside out, turned"}));
    EXPECT_GT(signed_volume(mesh).value, 0.0);
    EXPECT_FALSE(normals_oppose_winding(mesh));
}

TEST(MeshRepair, TurnsWindingAndNormalsEachWhereWrong) {
    Mesh good = cube();
    make_normals(good, kPi);
    Mesh wound_wrong = good;  // normals are right
    turn_inside_out(wound_wrong);
    for (glm::vec3& n : wound_wrong.normals) n = -n;
    Mesh normals_wrong = good;
    for (glm::vec3& n : normals_wrong.normals) n = -n;
    Mesh both_wrong = good;
    turn_inside_out(both_wrong);
    for (Mesh* mesh : {&good, &wound_wrong, &normals_wrong, &both_wrong}) {
        repair(*mesh, false);
        EXPECT_GT(signed_volume(*mesh).value, 0.0);
        for (std::size_t v = 0; v < mesh->positions.size(); ++v)
            EXPECT_GT(glm::dot(mesh->normals[v], mesh->positions[v]), 0.0f) << "a normal points inwards";
    }
}

TEST(MeshRepair, HollowBodyIsNotTurned) {
    Mesh inner = cube(0.5f);
    turn_inside_out(inner);
    Mesh hollow = joined(cube(), inner);
    EXPECT_TRUE(repair(hollow).empty());
    EXPECT_NEAR(signed_volume(hollow).value, 1.0 - 0.125, 1e-6);
}

TEST(MeshRepair, EveryShellIsTurnedOnItsOwn) {
    Mesh inverted = cube(1.0f, {3, 0, 0});
    turn_inside_out(inverted);
    for (const bool first : {false, true}) {
        Mesh bodies = first ? joined(inverted, cube()) : joined(cube(), inverted);
        EXPECT_EQ(repair(bodies, false), (std::vector<std::string>{"cube: 1 of 2 shells wound inside out, turned"}));
        EXPECT_NEAR(signed_volume(bodies).value, 2.0, 1e-6);
        EXPECT_FALSE(normals_oppose_winding(bodies));
    }
}

TEST(MeshRepair, SqueezedTriangleDoesNotKeepAShellFromBeingTurned) {
    Mesh inverted = cube(1.0f, {3, 0, 0});
    turn_inside_out(inverted);
    // A vertex on an edge: two triangles for one, and a line in between that closes the surface.
    const glm::uvec3 t = inverted.triangles[0];
    const auto middle = std::uint32_t(inverted.positions.size());
    inverted.positions.push_back(0.5f * (inverted.positions[t.x] + inverted.positions[t.y]));
    inverted.triangles[0] = {t.x, middle, t.z};
    inverted.triangles.emplace_back(middle, t.y, t.z);
    inverted.triangles.emplace_back(t.x, t.y, middle);
    Mesh bodies = joined(cube(), inverted);
    repair(bodies);
    EXPECT_NEAR(signed_volume(bodies).value, 2.0, 1e-6);
}

TEST(MeshRepair, InwardShellThatCrossesAnotherIsNoCavity) {
    Mesh inverted = cube(1.0f, {0.5f, 0.25f, 0.125f});
    turn_inside_out(inverted);
    Mesh bodies = joined(cube(), inverted);
    EXPECT_EQ(repair(bodies).size(), 1u);
    EXPECT_NEAR(signed_volume(bodies).value, 2.0, 1e-6);
}

TEST(MeshRepair, InwardShellAroundACavityIsTurnedAlone) {
    Mesh outer = cube(), inner = cube(0.5f);
    turn_inside_out(outer);
    turn_inside_out(inner);
    Mesh hollow = joined(outer, inner);
    EXPECT_EQ(repair(hollow).size(), 1u);
    EXPECT_NEAR(signed_volume(hollow).value, 1.0 - 0.125, 1e-6) << "the inner wall still bounds a cavity";
}

TEST(MeshRepair, NearlyClosedIsTurnedButASheetIsNot) {
    Mesh holed = cube();
    holed.triangles.pop_back();
    turn_inside_out(holed);
    repair(holed);
    EXPECT_GT(signed_volume(holed).value, 0.0);

    Mesh sheet;
    sheet.positions = {{0, 0, 0}, {1, 0, 0.1f}, {1, 1, 0}, {0, 1, 0.1f}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (int turned = 0; turned < 2; ++turned) {
        const auto before = sheet.triangles;
        EXPECT_FALSE(signed_volume(sheet).meaningful());
        const auto warnings = repair(sheet);
        EXPECT_EQ(warnings.size(), 1u) << "only that it is open";
        EXPECT_EQ(face_normal(sheet, sheet.triangles[0]).z > 0, turned == 0);
        turn_inside_out(sheet);
    }
}

TEST(MeshRepair, OpaqueMeshesAreLeftAsTheyAre) {
    Mesh mesh = cube();
    turn_inside_out(mesh);
    mesh.triangles.push_back({0, 0, 1});
    Warnings warnings;
    MeshOrigin origin;
    repair_mesh(mesh, origin, warnings);
    EXPECT_TRUE(warnings.lines().empty());
    EXPECT_EQ(mesh.triangles.size(), 13u);
    EXPECT_LT(signed_volume(mesh).value, 0.0);
}

TEST(MeshNormals, CreaseAngleDecidesWhatIsShared) {
    Mesh smooth = unwelded(cube());
    make_normals(smooth, kPi);
    for (std::size_t v = 0; v < smooth.positions.size(); ++v)
        EXPECT_GT(glm::dot(smooth.normals[v], glm::normalize(smooth.positions[v])), 0.8f);

    Mesh creased = cube();
    make_normals(creased, radians_from_degrees(89.0f));
    EXPECT_EQ(creased.positions.size(), 24u);
    Mesh shared = cube();
    make_normals(shared, radians_from_degrees(91.0f));
    EXPECT_EQ(shared.positions.size(), 8u);
    Mesh flat = cube();
    make_normals(flat, 0.0f);
    EXPECT_EQ(flat.positions.size(), 36u);
    for (const Mesh* mesh : {&creased, &flat})
        for (const glm::uvec3 t : mesh->triangles)
            for (int k = 0; k < 3; ++k) EXPECT_LT(glm::length(mesh->normals[t[k]] - face_normal(*mesh, t)), 1e-6f);
    EXPECT_TRUE(edges_of(creased).closed());
}

TEST(MeshNormals, AreWeightedByArea) {
    // Two sides of a roof, one twice as wide: the ridge's normal leans towards it.
    Mesh roof;
    roof.positions = {{0, 0, 0}, {0, 0, 1}, {2, 0, 0}, {2, 0, 1}, {0, -1, 0}, {0, -1, 1}};
    roof.triangles = {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}};
    make_normals(roof, kPi);
    const glm::vec3 expected = glm::normalize(glm::vec3(-2, 4, 0));  // twice the areas, both triangles
    EXPECT_LT(glm::length(roof.normals[0] - expected), 1e-6f);
}

TEST(MeshNormals, SheetWithTwoFacesGetsUnitNormals) {
    Mesh sheet;
    sheet.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 1}};
    for (const float crease : {0.0f, 1.0f, kPi}) {
        Mesh mesh = sheet;
        make_normals(mesh, crease);
        for (const glm::vec3 n : mesh.normals) EXPECT_NEAR(std::abs(n.z), 1.0f, 1e-6f);
    }
}

TEST(MeshNormals, BadOnesAreReplacedAndOthersScaled) {
    Mesh mesh = cube();
    make_normals(mesh, kPi);
    const std::vector<glm::vec3> good = mesh.normals;
    for (glm::vec3& n : mesh.normals) n *= 5.0f;
    mesh.normals[1] = {0, 0, 0};
    mesh.normals[2] = {NAN, 0, 1};
    mesh.normals[3] = {INFINITY, 0, 1};
    EXPECT_EQ(make_normals_valid(mesh), 3u);
    for (std::size_t v = 0; v < good.size(); ++v) EXPECT_LT(glm::length(mesh.normals[v] - good[v]), 1e-6f);
}

TEST(MeshNormals, ManyTrianglesAroundOneVertex) {
    // A cone: quadratic work at its tip would take minutes.
    constexpr int kSides = 200000;
    Mesh cone;
    cone.positions.push_back({0, 0, 1});
    for (int i = 0; i < kSides; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kSides;
        cone.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
        cone.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % kSides);
    }
    make_normals(cone, 1.0f);
    EXPECT_EQ(cone.positions.size(), std::size_t(kSides) + 1);
}

}  // namespace
}  // namespace pellucid
