#pragma once

#include "scene/warnings.h"

#include <pellucid/scene.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

/// For each position the index of the first equal position (-0 equals 0). Files split vertices where normals or
/// texture coordinates are discontinuous. The surface is connected only once such vertices are welded.
std::vector<std::uint32_t> weld_positions(std::span<const glm::vec3> positions);
/// For each vertex the index of the first with equal position and normal.
std::vector<std::uint32_t> weld_vertices(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals);

/// Merges vertices that agree in all attributes. Drops vertices without a triangle, which would enlarge the bounding
/// sphere.
void join_identical_vertices(Mesh& mesh);
/// Drops vertices without a triangle. Returns the old index of each remaining vertex.
std::vector<std::uint32_t> drop_unused_vertices(Mesh& mesh);

/// Copies old vertex source[i] to new vertex i. Triangles are unchanged.
void gather_vertices(Mesh& mesh, const std::vector<std::uint32_t>& source);

/// Defective edges of a surface welded by position. A closed solid has none.
struct EdgeCounts {
    std::uint64_t boundary = 0;      ///< with one triangle
    std::uint64_t non_manifold = 0;  ///< with more than two triangles
    std::uint64_t miswound = 0;      ///< with two triangles that run along it in the same direction
    bool closed() const { return boundary == 0 && non_manifold == 0 && miswound == 0; }
};
EdgeCounts count_edges(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> weld);

/// Removes triangles without area; returns how many.
std::size_t drop_zero_area_triangles(Mesh& mesh);

/// Volume enclosed by the surface, relative to the centre of its box. It is positive if triangles are
/// counter-clockwise seen from outside.
struct SignedVolume {
    double value = 0.0;
    /// Largest change of the value for any reference point in the bounding sphere of the box; 0 for a closed surface.
    /// If it reaches the value, the surface is too open to have an inside.
    double uncertainty = 0.0;
    bool meaningful() const { return std::abs(value) > uncertainty; }
};
SignedVolume signed_volume(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles);
inline SignedVolume signed_volume(const Mesh& mesh) { return signed_volume(mesh.positions, mesh.triangles); }

/// Reverses a vertex normal. The handedness of its tangent follows, if there is one: the bitangent stays.
void turn_normal(Mesh& mesh, std::size_t vertex);

/// Exchanges inside and outside: reverses winding and normals, if any.
void turn_inside_out(Mesh& mesh);

/// True if most triangles' vertex normals oppose their winding.
bool normals_oppose_winding(const Mesh& mesh);

/// Properties of a mesh from a file.
struct MeshOrigin {
    bool refractive = false;           ///< bounds a solid that transmits light, so orientation matters
    bool part_of_solid = false;        ///< already repaired by repair_solid_in_parts()
    bool make_normals = false;         ///< Mesh::normals is replaced by generated normals
    float crease_angle = 3.14159265f;  ///< crease angle of generated normals, radians
    bool deforms = false;              ///< degenerate triangles may gain area
};
/// Mapping of a repaired mesh's vertices.
struct MeshRepair {
    std::vector<std::uint32_t> source;  ///< for each vertex its index in the file
    bool normals_turned = false;        ///< normals of the file were kept, but reversed
};
/// Repairs a mesh from a file: winding, normals, unused vertices. Adds a warning with the mesh's name for every
/// change, and for every defect that remains visible.
MeshRepair repair_mesh(Mesh& mesh, const MeshOrigin& origin, Warnings& warnings);

}  // namespace pellucid
