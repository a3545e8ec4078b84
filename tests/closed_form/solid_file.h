#pragma once

// GLB files of balls and boxes of glass, written so that loading them exercises the loader's repair of solids.
#include "closed_form/closed_form_scene.h"
#include "unit/gltf_builder.h"

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <vector>

namespace pellucid::test {

/// The unit ball: an icosahedron whose faces were halved `levels` times, 20 * 4^levels triangles, exact normals.
Mesh ball_mesh(int levels = 5);
/// The cube -1..1 with flat normals.
Mesh box_mesh();

/// `mesh` in another frame, rounded once. An outward mesh stays outward where `to_from` mirrors.
Mesh moved(const Mesh& mesh, const glm::dmat4& to_from);
/// A shell as triangles, in the frame that its matrix leads to; outward, or inward for a cavity.
Mesh shell_mesh(const closed_form::Shell& shell, int ball_levels = 5);
/// Two convex shells as one surface that crosses itself: a triangle of each goes, and a tube inside both joins the holes.
/// So what it encloses is the union of both. Nothing where no triangle of the one is inside the other.
std::optional<Mesh> bridged_shells(const closed_form::Shell& a, const closed_form::Shell& b, int ball_levels = 5);
/// `more` after the triangles of `mesh`.
void append(Mesh& mesh, const Mesh& more);
/// Every triangle once more, wound the other way, with normals of its own.
Mesh double_sided(const Mesh& mesh);
/// Winds every triangle for which `turned` holds the other way. Normals stay.
template <class Predicate>
Mesh miswound(Mesh mesh, Predicate turned) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (turned(t)) std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
    return mesh;
}
/// The triangles of `mesh`, dealt out in `count` runs; each part has the vertices that it needs.
std::vector<Mesh> split(const Mesh& mesh, int count);

class SolidFile {
public:
    /// Glass of this medium; returns its number.
    int material(const closed_form::Medium& medium, double roughness = 0.0);
    /// A material of any kind, as glTF has it.
    int material(json material);
    /// A mesh of several primitives, one material each; returns its number.
    int mesh(const std::vector<Mesh>& primitives, const std::vector<int>& materials);
    int mesh(const Mesh& primitive, int material) { return mesh(std::vector<Mesh>{primitive}, {material}); }
    /// A placement of a mesh; the matrix is written in double precision.
    void node(int mesh, const glm::dmat4& world_from_mesh = glm::dmat4(1.0), int priority = 0);
    /// A camera of the file; Scene::cameras has it.
    void camera(const closed_form::View& view);
    /// The node last added, for what else a test has to say of it.
    json& last_node() { return builder_.root["nodes"].back(); }

    std::string write(const TemporaryFolder& folder);
    Scene load(const LoadOptions& options = {});

private:
    GltfBuilder builder_;
    int nodes_ = 0;
};

/// The same view for the library.
Camera camera_of(const closed_form::View& view);
closed_form::View view_of(const Camera& camera);

}  // namespace pellucid::test
