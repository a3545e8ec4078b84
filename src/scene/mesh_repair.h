#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

/// For each position the index of the first one that equals it exactly (-0 equals 0).
/// Files split vertices where normals or texture coordinates jump; the surface itself is only
/// connected after such vertices count as one.
std::vector<std::uint32_t> weld_positions(std::span<const glm::vec3> positions);
/// The same for positions and normals together.
std::vector<std::uint32_t> weld_vertices(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals);

/// Makes one vertex of those that agree in all their attributes, and drops vertices without a
/// triangle (which would otherwise count for the bounding sphere).
void join_identical_vertices(Mesh& mesh);
/// Returns for each vertex that stays the one that it was before.
std::vector<std::uint32_t> drop_unused_vertices(Mesh& mesh);

/// New vertex i becomes a copy of the old vertex source[i]; triangles stay as they are.
void gather_vertices(Mesh& mesh, const std::vector<std::uint32_t>& source);

/// Edges of a surface, welded by position. A closed solid has none of these.
struct EdgeCounts {
    std::uint64_t boundary = 0;      ///< with one triangle
    std::uint64_t non_manifold = 0;  ///< with more than two triangles
    std::uint64_t miswound = 0;      ///< with two triangles that run along it in the same direction
    bool closed() const { return boundary == 0 && non_manifold == 0 && miswound == 0; }
};
EdgeCounts count_edges(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> weld);

/// Removes triangles without area; returns how many.
std::size_t drop_zero_area_triangles(Mesh& mesh);

/// Volume enclosed by the surface, about the centre of its box: positive if triangles are
/// counter-clockwise seen from outside.
struct SignedVolume {
    double value = 0.0;
    /// How much the value would change with the reference point, anywhere in the bounding sphere of
    /// the box. It is zero for a closed surface; where it reaches the value, the surface is so open
    /// that it has no inside.
    double uncertainty = 0.0;
    bool meaningful() const { return std::abs(value) > uncertainty; }
};
SignedVolume signed_volume(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles);
inline SignedVolume signed_volume(const Mesh& mesh) { return signed_volume(mesh.positions, mesh.triangles); }

/// Exchanges inside and outside: winding and normals (if there are any).
void turn_inside_out(Mesh& mesh);

/// True if in most triangles the vertex normals lie on the other side than the winding says.
bool normals_oppose_winding(const Mesh& mesh);

/// What is known about a mesh that comes from a file.
struct MeshOrigin {
    bool refractive = false;           ///< bounds a solid that light goes through, so inside and outside matter
    bool part_of_solid = false;        ///< repair_solid_in_parts() has been here
    bool make_normals = false;         ///< Mesh::normals is ignored and made anew
    float crease_angle = 3.14159265f;  ///< for made normals, radians
    bool deforms = false;              ///< triangles without area may get one
};
/// What became of a mesh's vertices.
struct MeshRepair {
    std::vector<std::uint32_t> source;  ///< for each vertex the one of the file that it was
    bool normals_turned = false;        ///< those of the file are kept, and point the other way
};
/// Makes what a file contains usable: winding, normals, no leftovers. Everything that was changed
/// or that will be seen as an error in the picture is added to `warnings` with the mesh's name.
MeshRepair repair_mesh(Mesh& mesh, const MeshOrigin& origin, Warnings& warnings);

}  // namespace pellucid
