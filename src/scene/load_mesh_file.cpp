#include "scene/load_mesh_file.h"

#include "core/fail.h"
#include "core/file.h"
#include "core/memory_budget.h"
#include "scene/far_positions.h"
#include "scene/glass_scene.h"
#include "scene/mesh_files/file_meshes.h"
#include "scene/mesh_files/mtl_materials.h"
#include "scene/mesh_files/obj_scene.h"
#include "scene/mesh_files/read_mesh_files.h"
#include "scene/mesh_repair.h"

#include <pellucid/file.h>

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace pellucid {
namespace {

PolygonFile read_polygons(const std::filesystem::path& file, const std::string& extension, MemoryBudget& memory,
                          Warnings& warnings) {
    // Text of a few bytes becomes a corner of 12, or a position of 24.
    constexpr std::uint64_t kMostGrowth = 6;
    memory.take(check_readable(file), kMostGrowth);
    std::vector<std::byte> bytes = read_file(file);
    if (bytes.empty()) fail(file, "is empty");
    if (extension == ".obj") return read_obj(file, std::move(bytes), warnings);
    if (extension == ".ply") return read_ply(file, std::move(bytes), warnings);
    if (extension == ".stl") return read_stl(file, std::move(bytes), warnings);
    if (extension == ".off") return read_off(file, std::move(bytes), warnings);
    return read_3ds(file, bytes, warnings);
}

/// Of a file without polygons.
std::string what_it_is(const PolygonFile& content) {
    if (content.lines > 0) return fmt::format("contains no triangles, only {} lines", content.lines);
    if (content.positions.empty()) return "contains no triangles";
    return fmt::format("contains no triangles, only {} points; make a surface of them first", content.positions.size());
}

/// Materials of the file. None where it is glass as a whole: it has none, or `options` asks for glass and none is.
std::vector<MtlMaterial> chosen_materials(const std::filesystem::path& file, const PolygonFile& content,
                                          const LoadOptions& options, Warnings& warnings) {
    std::vector<MtlMaterial> materials = read_obj_materials(file, content, options.allow_outside, warnings);
    if (materials.empty() || std::any_of(materials.begin(), materials.end(), is_glass)) return materials;
    const std::string name = file.filename().string();
    if (!options.ior && !options.attenuation_color && !options.attenuation_distance) {
        if (!options.translucent)
            warnings.add(
                fmt::format("{}: none of its materials is glass; --ior 1.5 draws the whole file as glass", name));
        return materials;
    }
    warnings.add(fmt::format("{}: its materials are left out: none is glass, and glass was asked for", name));
    return {};
}

Scene whole_glass(const std::filesystem::path& file, const PolygonFile& content, const glm::dvec3& origin, bool facets,
                  const LoadOptions& options, Warnings& warnings) {
    PartChoice part;
    part.origin = origin;
    std::size_t lost_normals = 0;
    Mesh mesh = mesh_of_part(content, part, lost_normals);
    mesh.name = file.stem().string();
    if (lost_normals > 0)
        warnings.add(
            fmt::format("{}: {} corners of faces have normals, others none: made anew", mesh.name, lost_normals));
    if (std::any_of(content.colors.begin(), content.colors.end(), [](auto& color) { return color != glm::vec4(1.0f); }))
        warnings.add(fmt::format("{}: colours of vertices are not used: the file is glass", file.filename().string()));
    LoadOptions how = options;
    if (facets && how.crease_angle == kCreasesByShell) how.crease_angle = 0.0f;
    Scene scene = glass_scene(std::move(mesh), how, !options.remake_normals, warnings);
    if (facets) join_identical_vertices(scene.meshes.front());  // of facets in one plane
    return scene;
}

}  // namespace

Scene load_mesh_file(const std::filesystem::path& file, const LoadOptions& options, Warnings& warnings) {
    const std::string extension = lower_extension(file), name = file.stem().string();
    MemoryBudget memory(file);
    const PolygonFile content = read_polygons(file, extension, memory, warnings);
    // Indices, normals and maps of edges while a mesh is repaired, for a corner of a polygon. Measured: 60.
    constexpr std::uint64_t kBytesPerCorner = 64;
    memory.take(content.corners.size(), kBytesPerCorner);
    if (content.ends.empty()) fail(file, what_it_is(content));
    if (content.points + content.lines > 0)
        warnings.add(fmt::format("{}: {} points and {} lines left out", name, content.points, content.lines));
    const Box box = used_box(file, content);
    if (content.single_precision) {
        CoarsePositions coarse(box.extent());
        coarse.add(name, box, 1.0);
        coarse.warn(warnings);
    }
    const glm::dvec3 origin = frame_origin(box);
    const std::vector<MtlMaterial> materials = chosen_materials(file, content, options, warnings);
    // The normals of .stl files are those of the facets, or zero where a program left them out.
    const bool facets = extension == ".stl" && !options.remake_normals;
    Scene scene = materials.empty() ? whole_glass(file, content, origin, facets, options, warnings)
                                    : obj_scene(file, content, materials, origin, options, memory, warnings);
    scene.origin = origin;
    return scene;
}

}  // namespace pellucid
