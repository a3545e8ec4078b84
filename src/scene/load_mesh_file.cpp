#include "scene/load_mesh_file.h"

#include "core/fail.h"
#include "core/file.h"
#include "core/math.h"
#include "scene/far_positions.h"
#include "scene/mesh_file_checks.h"
#include "scene/mesh_repair.h"
#include "scene/text_positions.h"

#include <pellucid/file.h>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid {
namespace {

/// Opens nothing. OBJ files name material libraries, which are not wanted, and a hostile one could
/// name a pipe.
class NoFiles final : public Assimp::IOSystem {
public:
    bool Exists(const char*) const override { return false; }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
    void Close(Assimp::IOStream*) override {}
};

std::string cause_of(const Assimp::Importer& importer) {
    std::string cause = importer.GetErrorString();
    // assimp reads from memory here and reports a name that it made up for that.
    for (std::size_t at; (at = cause.find("$$$___magic___$$$")) != cause.npos;) cause.replace(at, 17, "file");
    return cause.empty() ? "cannot be read" : cause;
}

/// Nothing after this may meet a number that is not finite or an index that points nowhere.
void check_parts(const std::filesystem::path& file, const aiScene& scene) {
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& part = *scene.mMeshes[m];
        for (unsigned v = 0; v < part.mNumVertices; ++v) {
            const aiVector3D& p = part.mVertices[v];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                fail(file, fmt::format("mesh \"{}\": position of vertex {} is not finite", part.mName.C_Str(), v));
        }
        for (unsigned f = 0; f < part.mNumFaces; ++f)
            for (unsigned k = 0; k < part.mFaces[f].mNumIndices; ++k)
                if (part.mFaces[f].mIndices[k] >= part.mNumVertices)
                    fail(file, fmt::format("mesh \"{}\": face {} refers to vertex {}, there are {}", part.mName.C_Str(),
                                           f, part.mFaces[f].mIndices[k], part.mNumVertices));
    }
}

std::uint64_t face_count(const aiScene& scene) {
    std::uint64_t count = 0;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) count += scene.mMeshes[m]->mNumFaces;
    return count;
}

/// Some readers flag polygons where there are none, at which assimp's triangulation aborts the
/// program (it is built with assertions).
void correct_primitive_types(const aiScene& scene) {
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        aiMesh& part = *scene.mMeshes[m];
        bool polygons = false;
        for (unsigned f = 0; f < part.mNumFaces; ++f) polygons = polygons || part.mFaces[f].mNumIndices > 3;
        if (!polygons) part.mPrimitiveTypes = aiPrimitiveType_TRIANGLE;  // no more than triangles
    }
}

glm::dmat4 matrix_of(const aiMatrix4x4& m) {
    // aiMatrix4x4 lists rows.
    return glm::transpose(
        glm::dmat4(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4));
}

/// What has fewer than three corners after triangulation.
struct Leftovers {
    std::uint64_t points = 0;
    std::uint64_t lines = 0;
};

void append_part(const std::filesystem::path& file, const aiMesh& part, const glm::dmat4& placed, bool with_normals,
                 Mesh& mesh, Leftovers& leftovers) {
    if (!part.HasFaces()) return;
    const std::size_t base = mesh.positions.size();
    if (base + part.mNumVertices > std::numeric_limits<std::uint32_t>::max()) fail(file, "more than 2^32 vertices");
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
        const aiVector3D& p = part.mVertices[v];
        mesh.positions.emplace_back(placed * glm::dvec4(p.x, p.y, p.z, 1.0));
    }
    const glm::dmat3 linear(placed);
    if (with_normals) {
        const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(linear));
        for (unsigned v = 0; v < part.mNumVertices; ++v) {
            const aiVector3D& n = part.mNormals[v];
            mesh.normals.emplace_back(normal_matrix * glm::dvec3(n.x, n.y, n.z));
        }
    }
    const bool mirrored = glm::determinant(linear) < 0.0;
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
        const aiFace& face = part.mFaces[f];
        leftovers.points += face.mNumIndices == 1;
        leftovers.lines += face.mNumIndices == 2;
        if (face.mNumIndices != 3) continue;
        glm::uvec3 t(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
        if (mirrored) std::swap(t.y, t.z);
        mesh.triangles.push_back(t + static_cast<unsigned>(base));
    }
}

Mesh merge_parts(const std::filesystem::path& file, const aiScene& scene, Leftovers& leftovers) {
    Mesh mesh;
    bool with_normals = true;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        with_normals = with_normals && (scene.mMeshes[m]->HasNormals() || !scene.mMeshes[m]->HasFaces());

    struct Placed {
        const aiNode* node;
        glm::dmat4 world_from_parent;
    };
    std::vector<Placed> open = {{scene.mRootNode, glm::dmat4(1.0)}};
    while (!open.empty()) {
        const Placed placed = open.back();
        open.pop_back();
        if (!placed.node) continue;
        const glm::dmat4 world = placed.world_from_parent * matrix_of(placed.node->mTransformation);
        for (unsigned i = 0; i < placed.node->mNumMeshes; ++i)
            append_part(file, *scene.mMeshes[placed.node->mMeshes[i]], world, with_normals, mesh, leftovers);
        for (unsigned i = placed.node->mNumChildren; i-- > 0;) open.push_back({placed.node->mChildren[i], world});
    }
    for (const glm::vec3 p : mesh.positions)
        if (!std::isfinite(p.x + p.y + p.z)) fail(file, "a transformed position is not finite");
    const bool all_zero =
        std::all_of(mesh.normals.begin(), mesh.normals.end(), [](const glm::vec3& n) { return n == glm::vec3(0.0f); });
    if (all_zero) mesh.normals.clear();
    return mesh;
}

}  // namespace

MeshFile load_mesh_file(const std::filesystem::path& file, Warnings& warnings) {
    std::vector<std::byte> bytes = read_file(file);
    const std::string extension = lower_extension(file);
    const std::optional<std::uint64_t> announced = check_mesh_file(file, extension, bytes);
    MeshFile result;
    result.origin = rebase_stored_positions(extension, bytes);

    Assimp::Importer importer;
    importer.SetIOHandler(new NoFiles);  // the importer owns it
    // Polygons become triangles only after check_parts: triangulation believes every index.
    const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, extension.c_str() + 1);
    if (!scene || scene->mNumMeshes == 0) {
        const std::string cause = scene ? "contains no mesh" : cause_of(importer);
        fail(file, cause);
    }
    check_parts(file, *scene);
    if (announced && face_count(*scene) < *announced)
        warnings.add(fmt::format("{}: {} of {} faces could not be read", file.filename().string(),
                                 *announced - face_count(*scene), *announced));
    correct_primitive_types(*scene);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
    if (!scene) fail(file, cause_of(importer));

    Leftovers leftovers;
    Mesh& mesh = result.mesh;
    mesh = merge_parts(file, *scene, leftovers);
    mesh.name = file.stem().string();
    if (mesh.triangles.empty()) fail(file, "contains no triangles");
    if (leftovers.points + leftovers.lines > 0)
        warnings.add(fmt::format("{}: {} points and {} lines left out", mesh.name, leftovers.points, leftovers.lines));
    join_identical_vertices(mesh);
    const Box box = box_of(mesh.positions);
    CoarsePositions coarse(box.extent());
    coarse.add(mesh.name, box, 1.0);
    coarse.warn(warnings);
    result.origin += recentre(mesh);
    return result;
}

}  // namespace pellucid
