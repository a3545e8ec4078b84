// What a solid is: shells, their repair, bodies and who displaces whom.
#include "built_scenes.h"
#include "closed_form/solid_file.h"
#include "core/math.h"
#include "scene/bodies.h"
#include "scene/join_open_objects.h"
#include "scene/mesh_repair.h"
#include "scene/repair_solid.h"
#include "scene/shell_windings.h"
#include "scene/shells.h"
#include "test_files.h"
#include "traced_scenes.h"

#include <pellucid/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <tuple>
#include <utility>

namespace pellucid::test {
namespace {

Shells shells_of(const Mesh& mesh) {
    return find_shells(mesh.positions, mesh.triangles, weld_positions(mesh.positions));
}

/// A cube whose squares are cut along the other diagonal.
Mesh recut(Mesh mesh) {
    for (std::size_t t = 0; t + 1 < mesh.triangles.size(); t += 2) {
        const glm::uvec3 a = mesh.triangles[t], b = mesh.triangles[t + 1];
        mesh.triangles[t] = {a.x, a.y, b.z};
        mesh.triangles[t + 1] = {a.y, a.z, b.z};
    }
    return mesh;
}

std::vector<std::string> repaired(Mesh& mesh) {
    Warnings warnings;
    repair_solid(mesh, false, warnings);
    return warnings.lines();
}

double volume_of(const Mesh& mesh) { return signed_volume(mesh).value; }

TEST(Shells, WhatOnlyTouchesIsApart) {
    EXPECT_EQ(shells_of(joined(cube(), cube(1.0f, {1, 1, 0}))).count(), 2u) << "an edge in common";
    const Shells faces = shells_of(joined(cube(), recut(cube(1.0f, {1, 0, 0}))));
    EXPECT_EQ(faces.count(), 2u) << "a face in common";
    EXPECT_TRUE(faces.all_closed());
    EXPECT_EQ(std::set<std::uint32_t>(faces.of_triangle.begin(), faces.of_triangle.begin() + 12).size(), 1u);
    EXPECT_EQ(shells_of(joined(cube(), cube(1.0f, {1, 1, 1}))).count(), 2u) << "a corner in common";
}

// Whichever way the wall between two cubes lies, and however it is rounded.
TEST(Shells, CubesFaceToFaceAreTwoHoweverTheyAreTurned) {
    const Mesh pair = joined(cube(), recut(cube(1.0f, {1, 0, 0})));
    for (int turn = 0; turn < 500; ++turn) {
        const glm::vec3 axis(std::sin(1.3f * turn), std::cos(2.1f * turn), std::sin(0.7f * turn + 1.0f));
        const glm::mat4 way =
            glm::rotate(glm::mat4(1.0f), turn % 4 == 0 ? 1.5707964f * float(turn / 4) : 0.37f * float(turn),
                        turn % 4 == 0 ? glm::vec3(turn % 3 == 0, turn % 3 == 1, turn % 3 == 2) : glm::normalize(axis));
        Mesh turned = pair;
        for (glm::vec3& p : turned.positions) p = glm::vec3(way * glm::vec4(p, 1.0f));
        turned.positions = [&] {  // vertices of the wall are those of both
            std::vector<glm::vec3> shared = turned.positions;
            for (glm::vec3& p : shared)
                for (const glm::vec3& q : turned.positions)
                    if (glm::distance(p, q) < 1e-5f) {
                        p = q;
                        break;
                    }
            return shared;
        }();
        EXPECT_EQ(shells_of(turned).count(), 2u) << turn;
    }
}

TEST(Shells, AreOpenOneByOne) {
    Mesh mesh = joined(cube(), cube(1.0f, {3, 0, 0}));
    mesh.triangles.pop_back();
    const Shells shells = shells_of(mesh);
    ASSERT_EQ(shells.count(), 2u);
    EXPECT_EQ(shells.closed[0], 1);
    EXPECT_EQ(shells.closed[1], 0);
}

std::vector<WindingRange> windings_of(const Mesh& mesh) {
    return winding_ranges(mesh.positions, mesh.triangles, shells_of(mesh));
}

closed_form::Shell ball_at(double x, double radius = 1.0) {
    closed_form::Shell shell;
    shell.world_from_shell = glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(x, 0.1, 0.0)), glm::dvec3(radius));
    return shell;
}

TEST(ShellWindings, OfSimpleShells) {
    EXPECT_EQ(windings_of(cube()), std::vector<WindingRange>({{0, 1}}));
    EXPECT_EQ(windings_of(inside_out(cube())), std::vector<WindingRange>({{-1, 0}}));
    EXPECT_EQ(windings_of(ball_mesh(4)), std::vector<WindingRange>({{0, 1}}));
    EXPECT_EQ(windings_of(joined(cube(), cube(1.0f, {0.5f, 0.5f, 0.5f}))), std::vector<WindingRange>({{0, 1}, {0, 1}}))
        << "two shells cross each other, none itself";
}

TEST(ShellWindings, OfShellsThatCrossThemselves) {
    const Mesh overlap = bridged_shells(ball_at(-0.5), ball_at(0.5), 4).value();
    ASSERT_EQ(shells_of(overlap).count(), 1u);
    ASSERT_TRUE(shells_of(overlap).all_closed());
    EXPECT_EQ(windings_of(overlap), std::vector<WindingRange>({{0, 2}}));
    EXPECT_EQ(windings_of(inside_out(overlap)), std::vector<WindingRange>({{-2, 0}}));
    // Small against the ball that it reaches into, but with a few triangles in there.
    const Mesh bump = bridged_shells(ball_at(0.0), ball_at(1.0, 0.15), 4).value();
    EXPECT_EQ(windings_of(bump), std::vector<WindingRange>({{0, 2}}));
}

TEST(RepairSolid, TrianglesDrawnTwiceGo) {
    Mesh mesh = joined(cube(), cube());
    EXPECT_EQ(repaired(mesh), std::vector<std::string>{"cube: 12 triangles drawn more than once, left out"});
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_NEAR(volume_of(mesh), 1.0, 1e-6);
}

TEST(RepairSolid, OneSideOfTwoIsKept) {
    Mesh mesh = joined(cube(), inside_out(cube()));
    EXPECT_EQ(repaired(mesh),
              std::vector<std::string>{"cube: 12 triangles that are the other sides of triangles, left out"});
    EXPECT_NEAR(volume_of(mesh), 1.0, 1e-6);
}

TEST(RepairSolid, WallsInsideGo) {
    Mesh mesh = joined(cube(), cube(1.0f, {0, 0, 1}));
    const std::vector<std::string> lines = repaired(mesh);
    // The wall's squares are cut alike from both sides only in one direction; see recut().
    Mesh other = joined(cube(), recut(cube(1.0f, {0, 0, 1})));
    const std::vector<std::string> others = repaired(other);
    EXPECT_EQ(std::min(mesh.triangles.size(), other.triangles.size()), 20u);
    EXPECT_NE(lines, others);
    EXPECT_NEAR(volume_of(mesh), 2.0, 1e-6);
    EXPECT_NEAR(volume_of(other), 2.0, 1e-6);
}

TEST(RepairSolid, TrianglesFollowTheirNeighbours) {
    Mesh mesh = with_flat_normals(cube());
    const std::vector<glm::vec3> normals = mesh.normals;
    for (const std::size_t t : {1, 4, 7, 8}) std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
    EXPECT_EQ(repaired(mesh), std::vector<std::string>{"cube: 4 triangles wound against their neighbours, turned"});
    EXPECT_NEAR(volume_of(mesh), 1.0, 1e-6);
    EXPECT_EQ(mesh.normals, normals);
}

/// Gives every vertex a tangent.
Mesh with_tangents(Mesh mesh) {
    for (const glm::vec3 n : mesh.normals) mesh.tangents.emplace_back(n.y, n.z, n.x, 1.0f);
    return mesh;
}

/// A mesh that is wound inside out where `triangles` says so, or everywhere, with its normals.
Mesh turned(Mesh mesh, std::size_t first, std::size_t end) {
    for (std::size_t t = first; t < end; ++t) {
        std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
        for (int k = 0; k < 3; ++k) turn_normal(mesh, mesh.triangles[t][k]);
    }
    return mesh;
}

TEST(RepairSolid, TangentsFollowNormals) {
    const Mesh right = with_tangents(with_flat_normals(cube()));
    const Mesh pair = with_tangents(with_flat_normals(joined(cube(), cube(1.0f, {3, 0, 0}))));
    for (const auto& [good, first, end] :
         {std::tuple(right, 0, 12), std::tuple(pair, 12, 24), std::tuple(right, 2, 3)}) {
        Mesh mesh = turned(good, std::size_t(first), std::size_t(end));
        EXPECT_NE(mesh.tangents, good.tangents);
        EXPECT_EQ(repaired(mesh).size(), 1u);
        EXPECT_EQ(mesh.normals, good.normals);
        EXPECT_EQ(mesh.tangents, good.tangents) << first;
    }
    // The same in parts, of which one may lack normals.
    for (const bool normals : {true, false}) {
        Mesh lid = turned(right, 0, 12), rest = lid;
        lid.triangles.resize(2);
        rest.triangles.erase(rest.triangles.begin(), rest.triangles.begin() + 2);
        if (!normals) lid.normals.clear(), lid.tangents.clear();
        Warnings warnings;
        repair_solid_in_parts({&lid, &rest}, "cube", warnings);
        EXPECT_EQ(rest.normals, right.normals);
        EXPECT_EQ(rest.tangents, right.tangents);
        if (normals) {
            EXPECT_EQ(lid.tangents, right.tangents);
        }
    }
}

TEST(RepairSolid, ShellsThatStickOutAreNoCavities) {
    // Every middle of a side of the inward cube lies in the ball, its corners do not.
    Mesh ball = load_scene("shape:sphere").meshes.front();
    for (glm::vec3& p : ball.positions) p = glm::normalize(p);
    Mesh mesh = joined(ball, inside_out(cube(1.3f)));
    mesh.normals.clear();
    EXPECT_EQ(repaired(mesh).size(), 1u);
    EXPECT_GT(volume_of(mesh), 4.0);
    Mesh hollow = joined(ball, inside_out(cube(0.8f)));
    hollow.normals.clear();
    EXPECT_TRUE(repaired(hollow).empty());
    EXPECT_LT(volume_of(hollow), 4.0);
}

TEST(RepairSolid, VerticesAMicronApartAreJoined) {
    Mesh mesh = unwelded(cube());
    for (std::size_t v = 0; v < 12; ++v) mesh.positions[v] += glm::vec3(3e-7f, 0.0f, -3e-7f);
    const std::vector<std::string> lines = repaired(mesh);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("all but at the same place"), std::string::npos) << lines[0];
    EXPECT_TRUE(shells_of(mesh).all_closed());
}

TEST(Bodies, VolumeIsThatOfTheUnion) {
    const auto volume = [](const Mesh& mesh) {
        return find_bodies(scene_of(with_flat_normals(mesh))).all.front().surface->volume;
    };
    EXPECT_NEAR(volume(cube(2.0f)), 8.0, 1e-5);
    EXPECT_NEAR(volume(joined(cube(2.0f), inside_out(cube(1.0f)))), 7.0, 1e-5);
    // Measured along lines: good to their distance.
    EXPECT_NEAR(volume(joined(cube(2.0f), cube(2.0f, {1, 0, 0}))), 12.0, 0.1);
    EXPECT_NEAR(volume(joined(cube(2.0f), cube(1.0f))), 8.0, 0.1);
}

TEST(Bodies, PriorityThenVolumeThenOrderDecide) {
    Scene scene;
    // A rod across a room's diagonal has a large box, and little volume.
    const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), 0.8f, glm::vec3(1, 1, 0)) *
                             glm::scale(glm::mat4(1.0f), glm::vec3(0.1f, 0.1f, 9.0f));
    add(scene, with_flat_normals(cube()), glass(1.5f), turned);
    add(scene, with_flat_normals(cube(2.0f)), glass(1.4f));
    add(scene, with_flat_normals(cube(2.0f)), glass(1.3f));
    const auto ranks = [&] {
        std::vector<std::uint32_t> found;
        for (const Body& body : find_bodies(scene).all) found.push_back(body.rank);
        return found;
    };
    EXPECT_EQ(ranks(), (std::vector<std::uint32_t>{2, 0, 1}));
    scene.objects[1].priority = 1;
    EXPECT_EQ(ranks(), (std::vector<std::uint32_t>{1, 2, 0}));
}

TEST(Bodies, AreOfTheMediumOfMostOfTheirSurface) {
    Mesh lid = with_flat_normals(cube()), rest = lid;
    lid.triangles.resize(2);
    rest.triangles.erase(rest.triangles.begin(), rest.triangles.begin() + 2);
    Scene scene;
    add(scene, lid, glass(1.3f));
    add(scene, rest, glass(1.6f));
    scene.objects[0].body = scene.objects[1].body = 0;
    const Bodies bodies = find_bodies(scene);
    ASSERT_EQ(bodies.all.size(), 1u);
    EXPECT_EQ(bodies.all[0].material, 1u);
    EXPECT_TRUE(bodies.all[0].surface->shells.all_closed());
}

TEST(JoinOpenObjects, FacesOfOneCubeBecomeABody) {
    Mesh lid = with_flat_normals(cube()), rest = lid;
    lid.name = "lid", rest.name = "rest";
    lid.triangles.resize(2);
    rest.triangles.erase(rest.triangles.begin(), rest.triangles.begin() + 2);
    Scene scene;
    add(scene, rest, glass(), glm::translate(glm::mat4(1.0f), glm::vec3(2, 0, 0)));
    for (glm::vec3& p : lid.positions) p += glm::vec3(2, 0, 0);  // the same place, in another frame
    add(scene, lid, glass());
    for (Mesh& mesh : scene.meshes) mesh.tangents.assign(mesh.positions.size(), glm::vec4(1.0f));
    Scene moving = scene, apart = scene;
    Warnings warnings;
    warnings.add("rest: 4 boundary edges, 0 non-manifold edges: not a closed solid, refraction there is approximate");
    join_open_objects(scene, {0, 0}, warnings);
    EXPECT_EQ(warnings.lines(),
              std::vector<std::string>{"rest and lid: open surfaces that close each other, joined to one solid"});
    EXPECT_EQ(find_bodies(scene).all.size(), 1u);
    EXPECT_TRUE(find_bodies(scene).all[0].surface->shells.all_closed());
    for (const Object& object : scene.objects)
        EXPECT_TRUE(scene.meshes[std::size_t(object.mesh)].tangents.empty()) << "those were of another frame";

    Warnings none;
    join_open_objects(moving, {1, 0}, none);
    apart.materials[1].ior = 1.3f;
    join_open_objects(apart, {0, 0}, none);
    EXPECT_TRUE(none.lines().empty());
    EXPECT_EQ(find_bodies(moving).all.size() + find_bodies(apart).all.size(), 4u);
}

TEST(Priorities, AreGivenByNameAndRefusedWhereThereIsNone) {
    LoadOptions options;
    options.priorities = {{"cube", 3}};
    EXPECT_EQ(load_scene("shape:cube", options).objects.front().priority, 3);
    options.priorities = {{"rod", 1}};
    try {
        load_scene("shape:cube", options);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "shape:cube: priority: there is no object \"rod\" (known: cube)");
    }
}

/// Of the path tracer, through the middle of a parallel view.
glm::vec3 seen(const Scene& scene, const Camera& camera, std::uint32_t samples = 64) {
    PathTraceSettings settings;
    settings.width = settings.height = 1;
    settings.samples = samples;
    const PathTracedImage image = Tracer(scene).path_trace(camera, uniform(0.0f), settings);
    return {image.radiance.at(0, 0)[0], image.radiance.at(0, 0)[1], image.radiance.at(0, 0)[2]};
}

TEST(Sources, InAMediumAreDividedByItsIndexSquared) {
    Material lamp;
    lamp.emission = {2, 1, 0.5f};
    lamp.base_color = glm::vec4(0, 0, 0, 1);
    lamp.ior = 1.0f;
    Scene scene;
    add(scene, square(), lamp);
    const Camera camera = parallel_camera({0, 0, 0}, {0, 0, -1}, 1e-3f);
    const glm::vec3 in_air = seen(scene, camera);
    EXPECT_NEAR(in_air.r, 2.0f, 1e-4f);
    add(scene, with_flat_normals(cube(50.0f)), glass(1.33f));
    const glm::vec3 in_water = seen(scene, camera);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(in_water[c], in_air[c] / (1.33f * 1.33f), 1e-4f);
}

TEST(OpaqueSurfaces, OfOneSideAreSeenFromTheFrontOnly) {
    Material paint;
    paint.unlit = true;
    paint.double_sided = false;
    Scene scene;
    add(scene, square(), paint);
    EXPECT_FLOAT_EQ(seen(scene, parallel_camera({0, 0, 0}, {0, 0, -1}, 1e-3f)).r, 1.0f);
    EXPECT_FLOAT_EQ(seen(scene, parallel_camera({0, 0, 0}, {0, 0, 1}, 1e-3f)).r, 0.0f);
    scene.materials[0].double_sided = true;
    EXPECT_FLOAT_EQ(seen(scene, parallel_camera({0, 0, 0}, {0, 0, 1}, 1e-3f)).r, 1.0f);
}

TEST(ThinGlass, CoversWhatItsAlphaSays) {
    Material pane = glass(1.0f), paint;
    pane.thickness = 0.0f;
    pane.base_color = {1.0f, 0.0f, 0.0f, 0.25f};
    pane.alpha_is_coverage = true;
    paint.unlit = true;
    Scene scene;
    add(scene, square(), pane, glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, 1)));
    add(scene, square(), paint);
    const glm::vec3 both = seen(scene, parallel_camera({0, 0, 0}, {0, 0, -1}, 1e-3f), 4096);
    EXPECT_NEAR(both.r, 1.0f, 1e-5f);
    EXPECT_NEAR(both.g, 0.75f, 0.03f);  // 4 standard errors of 4096 choices
}

}  // namespace
}  // namespace pellucid::test
