// 3DS (Autodesk 3D Studio), by assimp.
#include "core/byte_stream.h"
#include "core/fail.h"
#include "core/memory_budget.h"
#include "core/read_apart.h"
#include "scene/apart_readers.h"
#include "scene/mesh_files/read_mesh_files.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <set>
#include <string>
#include <utility>

namespace pellucid {
namespace {

/// Opens nothing: the file is in memory, and names no other that is wanted.
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

/// A first chunk that is longer than the file ends in gigabytes of memory.
void check_first_chunk(const std::filesystem::path& file, const std::vector<std::byte>& bytes) {
    std::uint16_t id = 0;
    std::uint32_t length = 0;
    if (bytes.size() >= 6) {
        std::memcpy(&id, bytes.data(), 2);
        std::memcpy(&length, bytes.data() + 2, 4);
    }
    if (id != 0x4d4d) fail(file, "is no 3DS file: its first chunk is not 0x4D4D");
    if (length > bytes.size())
        fail(file, fmt::format("3DS: the file ends early: {} of {} bytes", bytes.size(), length));
}

glm::dmat4 matrix_of(const aiMatrix4x4& m) {
    // aiMatrix4x4 lists rows.
    return glm::transpose(
        glm::dmat4(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4));
}

void append_part(const std::filesystem::path& file, const aiMesh& part, const glm::dmat4& placed,
                 PolygonFile& content) {
    const std::size_t base = content.positions.size();
    if (base + part.mNumVertices >= kNoIndex) fail(file, "more than 2^32 vertices");
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
        const aiVector3D& p = part.mVertices[v];
        content.positions.emplace_back(placed * glm::dvec4(p.x, p.y, p.z, 1.0));
    }
    const bool normals = part.HasNormals();
    const std::size_t first_normal = content.normals.size();
    const glm::dmat3 linear(placed);
    const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(linear));
    for (unsigned v = 0; normals && v < part.mNumVertices; ++v) {
        const aiVector3D& n = part.mNormals[v];
        content.normals.emplace_back(normal_matrix * glm::dvec3(n.x, n.y, n.z));
    }
    const bool mirrored = glm::determinant(linear) < 0.0;
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
        const aiFace& face = part.mFaces[f];
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            const unsigned v = face.mIndices[mirrored ? face.mNumIndices - 1 - k : k];
            if (v >= part.mNumVertices)
                fail(file, fmt::format("mesh \"{}\": face {} refers to vertex {}, there are {}", part.mName.C_Str(), f,
                                       v, part.mNumVertices));
            content.corners.push_back(
                {.position = std::uint32_t(base) + v, .normal = normals ? std::uint32_t(first_normal) + v : kNoIndex});
        }
        if (face.mNumIndices > 0) content.end_polygon();
    }
}

PolygonFile polygons_of(const std::filesystem::path& file, const std::vector<std::byte>& bytes,
                        std::size_t& materials_left_out) {
    Assimp::Importer importer;
    importer.SetIOHandler(new NoFiles);  // the importer owns it
    const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, "3ds");
    if (!scene && importer.GetErrorString() == std::string("std::bad_alloc")) throw std::bad_alloc();
    if (!scene) fail(file, cause_of(importer));
    PolygonFile content;
    std::vector<std::pair<const aiNode*, glm::dmat4>> open = {{scene->mRootNode, glm::dmat4(1.0)}};
    while (!open.empty()) {
        const auto [node, world_from_parent] = open.back();
        open.pop_back();
        if (!node) continue;
        const glm::dmat4 world = world_from_parent * matrix_of(node->mTransformation);
        for (unsigned i = 0; i < node->mNumMeshes; ++i)
            append_part(file, *scene->mMeshes[node->mMeshes[i]], world, content);
        for (unsigned i = node->mNumChildren; i-- > 0;) open.emplace_back(node->mChildren[i], world);
    }
    std::set<unsigned> materials;
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) materials.insert(scene->mMeshes[i]->mMaterialIndex);
    if (materials.size() > 1) materials_left_out = materials.size();
    return content;
}

void check_references(const std::filesystem::path& file, const PolygonFile& content) {
    const auto fits = [](std::uint32_t index, std::size_t count) { return index == kNoIndex || index < count; };
    for (const PolygonCorner& corner : content.corners)
        if (corner.position >= content.positions.size() || !fits(corner.normal, content.normals.size()))
            fail(file, "refers to a vertex that does not exist");
    std::uint32_t last = 0;
    for (const std::uint32_t end : content.ends)
        if (end < std::exchange(last, end) + 3 || end > content.corners.size()) fail(file, "has a damaged polygon");
}

}  // namespace

std::vector<std::byte> read_3ds_here(std::span<const std::byte> request) {
    ByteReader reader(request);
    const std::string file = reader.text();
    std::size_t materials_left_out = 0;
    const PolygonFile content = polygons_of(file, reader.values<std::byte>(), materials_left_out);
    ByteWriter result;
    result.values(content.positions);
    result.values(content.normals);
    result.values(content.corners);
    result.values(content.ends);
    for (const std::uint64_t count : {content.points, content.lines, std::uint64_t(materials_left_out)})
        result.value(count);
    return result.take();
}

PolygonFile read_3ds(const std::filesystem::path& file, const std::vector<std::byte>& bytes, Warnings& warnings) {
    check_first_chunk(file, bytes);
    ByteWriter request;
    request.text(file.string());
    request.values(bytes);
    const std::vector<std::byte> result =
        read_apart(ApartKind::k3ds, read_3ds_here, request.take(), scene_memory(), file);
    ByteReader reader(result);
    PolygonFile content;
    content.single_precision = true;
    content.positions = reader.values<glm::dvec3>();
    content.normals = reader.values<glm::vec3>();
    content.corners = reader.values<PolygonCorner>();
    content.ends = reader.values<std::uint32_t>();
    content.points = reader.value<std::uint64_t>();
    content.lines = reader.value<std::uint64_t>();
    if (const auto materials = reader.value<std::uint64_t>(); materials > 0)
        warnings.add(fmt::format("{}: its {} materials are not used: the whole file is glass", file.filename().string(),
                                 materials));
    check_references(file, content);
    return content;
}

}  // namespace pellucid
