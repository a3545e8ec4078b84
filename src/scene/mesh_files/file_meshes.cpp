#include "scene/mesh_files/file_meshes.h"

#include "core/fail.h"
#include "scene/mesh_files/triangulate_polygon.h"
#include "scene/mesh_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace pellucid {

Box used_box(const std::filesystem::path& file, const PolygonFile& content) {
    constexpr double kLargest = 1e15;  // squares and products must stay finite in 32 bits
    Box box;
    for (const PolygonCorner& corner : content.corners) {
        const glm::dvec3& p = content.positions[corner.position];
        const double farthest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        if (!(std::isfinite(p.x + p.y + p.z) && farthest <= kLargest)) {
            const auto number = std::uint64_t(corner.position) + content.first_number;
            const std::string vertex = fmt::format("vertex {} at {:g} {:g} {:g}", number, p.x, p.y, p.z);
            if (!std::isfinite(p.x + p.y + p.z)) fail(file, vertex + " is not finite");
            fail(file, vertex + ": positions are too large (more than 1e15); scale the mesh down");
        }
        box.add(p);
    }
    return box;
}

Mesh mesh_of_part(const PolygonFile& content, const PartChoice& part, std::size_t& lost_normals) {
    Mesh mesh;
    std::size_t with_normal = 0, without_normal = 0;
    std::vector<glm::dvec3> polygon;
    const std::size_t count = part.polygons ? part.polygons->size() : content.ends.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t f = part.polygons ? (*part.polygons)[i] : i;
        const std::uint32_t begin = f > 0 ? content.ends[f - 1] : 0;
        const std::span<const PolygonCorner> corners(content.corners.data() + begin, content.ends[f] - begin);
        const auto first = std::uint32_t(mesh.positions.size());
        polygon.clear();
        for (const PolygonCorner& corner : corners) {
            polygon.push_back(content.positions[corner.position]);
            mesh.positions.emplace_back(polygon.back() - part.origin);
            const bool normal = corner.normal != kNoIndex;
            ++(normal ? with_normal : without_normal);
            if (!content.normals.empty())
                mesh.normals.push_back(normal ? content.normals[corner.normal] : glm::vec3(0.0f));
            if (part.colors) mesh.colors.push_back(content.colors[corner.position]);
            if (!part.texcoords) continue;
            const glm::vec2 t = corner.texcoord == kNoIndex ? glm::vec2(0.0f) : content.texcoords[corner.texcoord];
            mesh.texcoords[0].emplace_back(t.x, 1.0f - t.y);
        }
        if (corners.size() == 3) {
            mesh.triangles.emplace_back(first, first + 1, first + 2);
            continue;
        }
        for (const auto& [a, b, c] : triangulate_polygon(polygon))
            mesh.triangles.emplace_back(first + a, first + b, first + c);
    }
    lost_normals = without_normal > 0 ? with_normal : 0;
    const bool all_zero =
        std::all_of(mesh.normals.begin(), mesh.normals.end(), [](const glm::vec3& n) { return n == glm::vec3(0.0f); });
    if (without_normal > 0 || all_zero) mesh.normals.clear();
    join_identical_vertices(mesh);
    return mesh;
}

}  // namespace pellucid
