#include "scene/mesh_files/obj_scene.h"

#include "scene/join_open_objects.h"
#include "scene/mesh_files/file_meshes.h"
#include "scene/mesh_files/mtl_materials.h"
#include "scene/mesh_files/text_file.h"
#include "scene/mesh_repair.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <utility>

namespace pellucid {
namespace {

/// Adds the files that an mtllib statement names: one whose name may have blanks, or else several.
void find_libraries(const FileScope& scope, const std::string& names, std::vector<std::filesystem::path>& found,
                    std::vector<std::string>& missing) {
    if (std::filesystem::path whole = find_beside(scope.folder, names, scope); !whole.empty()) {
        found.push_back(std::move(whole));
        return;
    }
    std::vector<std::string> absent;
    const std::size_t before = found.size();
    Words words(names);
    for (std::string_view name = words.next(); !name.empty(); name = words.next()) {
        if (std::filesystem::path one = find_beside(scope.folder, name, scope); !one.empty()) {
            found.push_back(std::move(one));
        } else {
            absent.emplace_back(name);
        }
    }
    if (found.size() == before) absent = {names};
    missing.insert(missing.end(), absent.begin(), absent.end());
}

MtlMaterial named(const std::string& name) {
    MtlMaterial material;
    material.name = name;
    return material;
}

bool textured(const Material& material) {
    return material.base_color_texture.image >= 0 || material.emission_texture.image >= 0 ||
           material.normal_texture.image >= 0 || material.metallic_roughness_texture.image >= 0;
}

/// Glass that is no surface of a solid bends no light: a pane of one sheet.
void make_sheets_thin(Scene& scene, Warnings& warnings) {
    for (const Object& object : scene.objects) {
        Material& material = scene.materials[std::size_t(object.material)];
        const Mesh& mesh = scene.meshes[std::size_t(object.mesh)];
        if (!material.refractive() || object.body >= 0 || signed_volume(mesh).meaningful()) continue;
        material.thickness = 0.0f;
        warnings.drop(fmt::format("{}: ", object.name), "not a closed solid");
        warnings.add(fmt::format("{}: an open surface, drawn as thin glass that does not bend light", object.name));
    }
}

}  // namespace

std::vector<MtlMaterial> read_obj_materials(const std::filesystem::path& file, const PolygonFile& content,
                                            bool allow_outside, Warnings& warnings) {
    const FileScope scope{.folder = file.parent_path(), .allow_outside = allow_outside};
    std::vector<std::string> libraries = content.libraries, missing_files;
    std::sort(libraries.begin(), libraries.end());
    libraries.erase(std::unique(libraries.begin(), libraries.end()), libraries.end());
    std::vector<std::filesystem::path> files;
    for (const std::string& names : libraries) find_libraries(scope, names, files, missing_files);
    std::vector<MtlMaterial> known;
    for (const std::filesystem::path& library : files)
        for (MtlMaterial& material : read_mtl(library, scope, warnings)) known.push_back(std::move(material));

    std::vector<MtlMaterial> result;
    std::vector<std::string> missing;
    for (const std::string& wanted : content.material_names) {
        const auto found =
            std::find_if(known.begin(), known.end(), [&](const MtlMaterial& m) { return m.name == wanted; });
        if (found == known.end()) missing.push_back(wanted);
        result.push_back(found == known.end() ? named(wanted) : *found);
    }
    const bool none = missing.size() == result.size();
    const std::string name = file.filename().string();
    if (!missing_files.empty())
        warnings.add(fmt::format("{}: no such material file: {}{}", name, fmt::join(missing_files, ", "),
                                 none ? ": the whole file is glass" : ""));
    // Without material files, one name means nothing; several would have told things apart.
    else if (none && missing.size() > 1)
        warnings.add(
            fmt::format("{}: {} materials are in no material file: the whole file is glass", name, missing.size()));
    if (none) return {};
    if (!missing.empty())
        warnings.add(fmt::format("{}: material{} in no material file, drawn matt grey: {}", name,
                                 missing.size() == 1 ? "" : "s", fmt::join(missing, ", ")));
    result.push_back(named(file.stem().string()));
    return result;
}

Scene obj_scene(const std::filesystem::path& file, const PolygonFile& content,
                const std::vector<MtlMaterial>& materials, const glm::dvec3& origin, const LoadOptions& options,
                MemoryBudget& memory, Warnings& warnings) {
    Scene scene;
    std::vector<std::vector<std::uint32_t>> polygons(materials.size());  // the last without a material
    for (std::uint32_t f = 0; f < content.materials.size(); ++f)
        polygons[std::min<std::size_t>(content.materials[f], polygons.size() - 1)].push_back(f);
    if (!polygons.back().empty())
        warnings.add(fmt::format("{}: faces without a material, drawn matt grey", file.filename().string()));
    for (std::size_t m = 0; m < materials.size(); ++m) {
        if (polygons[m].empty()) continue;
        Material material = material_from_mtl(materials[m], scene, memory, warnings);
        PartChoice part;
        part.polygons = std::move(polygons[m]);
        part.origin = origin;
        part.texcoords = textured(material) && !content.texcoords.empty();
        part.colors = !content.colors.empty();
        if (textured(material) && content.texcoords.empty())
            warnings.add(fmt::format("material {}: its texture has no coordinates in the file", material.name));
        std::size_t lost_normals = 0;
        Mesh mesh = mesh_of_part(content, part, lost_normals);
        mesh.name = material.name;
        if (lost_normals > 0)
            warnings.add(
                fmt::format("{}: {} corners of faces have normals, others none: made anew", mesh.name, lost_normals));
        MeshOrigin how;
        how.refractive = material.refractive();
        how.make_normals = mesh.normals.empty() || options.remake_normals;
        how.crease_angle = options.crease_angle;
        repair_mesh(mesh, how, warnings);
        if (mesh.triangles.empty()) continue;
        Object object;
        object.name = mesh.name;
        object.mesh = int(scene.meshes.size());
        object.material = int(scene.materials.size());
        scene.objects.push_back(std::move(object));
        scene.meshes.push_back(std::move(mesh));
        scene.materials.push_back(std::move(material));
    }
    join_open_objects(scene, std::vector<char>(scene.objects.size(), 0), warnings);
    make_sheets_thin(scene, warnings);
    return scene;
}

}  // namespace pellucid
