#include "scene/mesh_repair.h"

#include "scene/mesh_normals.h"
#include "scene/repair_solid.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace pellucid {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

std::uint64_t mix(std::uint64_t h) {
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ull;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebull;
    return h ^ (h >> 31);
}

/// For each of `count` rows of floats the index of the first row with the same values.
/// Open addressing in a table at most half full.
std::vector<std::uint32_t> first_equal_row(const float* rows, std::size_t count, std::size_t width) {
    std::vector<std::uint32_t> table(std::bit_ceil(std::max<std::size_t>(count, 1) * 2), kNone);
    std::vector<std::uint32_t> first(count);
    const auto equal = [&](std::size_t a, std::size_t b) {
        return std::equal(rows + a * width, rows + (a + 1) * width, rows + b * width);
    };
    for (std::size_t i = 0; i < count; ++i) {
        std::uint64_t hash = width;
        // Adding +0 turns -0 into +0, which compares equal and so must hash equal.
        for (std::size_t k = 0; k < width; ++k)
            hash = mix(hash + 0x9e3779b97f4a7c15ull + std::bit_cast<std::uint32_t>(rows[i * width + k] + 0.0f));
        std::size_t slot = hash & (table.size() - 1);
        while (table[slot] != kNone && !equal(table[slot], i)) slot = (slot + 1) & (table.size() - 1);
        if (table[slot] == kNone) table[slot] = static_cast<std::uint32_t>(i);
        first[i] = table[slot];
    }
    return first;
}

template <typename T>
void gather(std::vector<T>& values, const std::vector<std::uint32_t>& source) {
    if (values.empty()) return;
    std::vector<T> gathered(source.size());
    std::transform(source.begin(), source.end(), gathered.begin(), [&](std::uint32_t i) { return values[i]; });
    values = std::move(gathered);
}

/// All attributes of the vertices as rows of floats.
std::vector<float> vertex_rows(const Mesh& mesh, std::size_t& width) {
    std::vector<float> rows;
    width = 3 + (mesh.normals.empty() ? 0u : 3u) + (mesh.texcoords[0].empty() ? 0u : 2u) +
            (mesh.texcoords[1].empty() ? 0u : 2u) + (mesh.colors.empty() ? 0u : 4u) + (mesh.tangents.empty() ? 0u : 4u);
    rows.reserve(width * mesh.positions.size());
    const auto put = [&](const auto& v) {
        for (int k = 0; k < v.length(); ++k) rows.push_back(v[k]);
    };
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        put(mesh.positions[i]);
        if (!mesh.normals.empty()) put(mesh.normals[i]);
        for (const auto& texcoords : mesh.texcoords)
            if (!texcoords.empty()) put(texcoords[i]);
        if (!mesh.colors.empty()) put(mesh.colors[i]);
        if (!mesh.tangents.empty()) put(mesh.tangents[i]);
    }
    return rows;
}

bool zero_area(const Mesh& mesh, glm::uvec3 t) {
    const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    const double longest = std::max({glm::length(b - a), glm::length(c - a), glm::length(c - b)});
    // Rounding of the file's floats alone moves a corner by 1e-7 of its distance from the origin;
    // only what is flat to the last digit is left out.
    return glm::length(glm::cross(b - a, c - a)) <= 1e-14 * longest * longest;
}

}  // namespace

std::vector<std::uint32_t> weld_positions(std::span<const glm::vec3> positions) {
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
    return first_equal_row(reinterpret_cast<const float*>(positions.data()), positions.size(), 3);
}

std::vector<std::uint32_t> weld_vertices(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals) {
    std::vector<float> rows;
    rows.reserve(6 * positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (const glm::vec3& v : {positions[i], normals[i]}) rows.insert(rows.end(), {v.x, v.y, v.z});
    return first_equal_row(rows.data(), positions.size(), 6);
}

void gather_vertices(Mesh& mesh, const std::vector<std::uint32_t>& source) {
    gather(mesh.positions, source);
    gather(mesh.normals, source);
    gather(mesh.texcoords[0], source);
    gather(mesh.texcoords[1], source);
    gather(mesh.colors, source);
    gather(mesh.tangents, source);
}

void join_identical_vertices(Mesh& mesh) {
    std::size_t width = 0;
    const std::vector<float> rows = vertex_rows(mesh, width);
    const std::vector<std::uint32_t> first = first_equal_row(rows.data(), mesh.positions.size(), width);
    for (glm::uvec3& t : mesh.triangles) t = {first[t.x], first[t.y], first[t.z]};
    drop_unused_vertices(mesh);
}

std::vector<std::uint32_t> drop_unused_vertices(Mesh& mesh) {
    std::vector<std::uint32_t> renamed(mesh.positions.size(), kNone);
    std::vector<std::uint32_t> source;
    for (glm::uvec3& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            std::uint32_t& name = renamed[t[k]];
            if (name == kNone) {
                name = static_cast<std::uint32_t>(source.size());
                source.push_back(t[k]);
            }
            t[k] = name;
        }
    }
    gather_vertices(mesh, source);
    return source;
}

EdgeCounts count_edges(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> weld) {
    // An edge is a number: smaller vertex, larger vertex, and in the last bit which way it is run.
    std::vector<std::uint64_t> edges;
    edges.reserve(triangles.size() * 3);
    for (const glm::uvec3 t : triangles) {
        const glm::uvec3 w(weld[t.x], weld[t.y], weld[t.z]);
        if (w.x == w.y || w.y == w.z || w.z == w.x) continue;  // two corners in one: only a line
        for (int k = 0; k < 3; ++k) {
            const std::uint64_t a = w[k], b = w[(k + 1) % 3];
            edges.push_back(a < b ? (a << 32 | b << 1) : (b << 32 | a << 1 | 1));
        }
    }
    std::sort(edges.begin(), edges.end());
    EdgeCounts counts;
    for (std::size_t begin = 0, end; begin < edges.size(); begin = end) {
        for (end = begin; end < edges.size() && (edges[end] >> 1) == (edges[begin] >> 1);) ++end;
        if (end - begin == 1) ++counts.boundary;
        if (end - begin > 2) ++counts.non_manifold;
        if (end - begin == 2 && edges[begin] == edges[begin + 1]) ++counts.miswound;
    }
    return counts;
}

std::size_t drop_zero_area_triangles(Mesh& mesh) {
    return std::erase_if(mesh.triangles, [&](glm::uvec3 t) { return zero_area(mesh, t); });
}

SignedVolume signed_volume(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const glm::uvec3 t : triangles) {
        for (int k = 0; k < 3; ++k) {
            low = glm::min(low, glm::dvec3(positions[t[k]]));
            high = glm::max(high, glm::dvec3(positions[t[k]]));
        }
    }
    if (triangles.empty()) return {};
    const glm::dvec3 center = 0.5 * (low + high);
    double volume = 0.0;
    glm::dvec3 area(0.0);
    for (const glm::uvec3 t : triangles) {
        const glm::dvec3 a = glm::dvec3(positions[t.x]) - center;
        const glm::dvec3 b = glm::dvec3(positions[t.y]) - center;
        const glm::dvec3 c = glm::dvec3(positions[t.z]) - center;
        volume += glm::dot(a, glm::cross(b, c)) / 6.0;
        area += 0.5 * glm::cross(b - a, c - a);
    }
    // Moving the reference point by d changes the sum by d . area / 3.
    return {volume, glm::length(area) * 0.5 * glm::length(high - low) / 3.0};
}

void turn_normal(Mesh& mesh, std::size_t vertex) {
    mesh.normals[vertex] = -mesh.normals[vertex];
    if (!mesh.tangents.empty()) mesh.tangents[vertex].w = -mesh.tangents[vertex].w;
}

void turn_inside_out(Mesh& mesh) {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) turn_normal(mesh, v);
}

bool normals_oppose_winding(const Mesh& mesh) {
    std::size_t opposed = 0;
    for (const glm::uvec3 t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const glm::dvec3 n = mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
        opposed += glm::dot(n, glm::cross(b - a, c - a)) < 0.0;
    }
    return 2 * opposed > mesh.triangles.size();
}

MeshRepair repair_mesh(Mesh& mesh, const MeshOrigin& origin, Warnings& warnings) {
    MeshRepair repair;
    if (origin.make_normals) {
        mesh.normals.clear();
        mesh.tangents.clear();
    }
    if (origin.refractive && !origin.part_of_solid)
        repair.normals_turned = repair_solid(mesh, origin.deforms, warnings).inside_out;
    std::vector<std::uint32_t> split;  // none of them, unless normals are made
    if (mesh.normals.empty()) {
        split = make_normals(mesh, origin.crease_angle);
        repair.normals_turned = false;
    } else {
        if (const std::size_t bad = make_normals_valid(mesh))
            warnings.add(fmt::format("{}: {} normals were zero or not finite, made anew", mesh.name, bad));
        if (origin.refractive && normals_oppose_winding(mesh)) {
            for (std::size_t v = 0; v < mesh.normals.size(); ++v) turn_normal(mesh, v);
            repair.normals_turned = !repair.normals_turned;
            warnings.add(fmt::format("{}: normals pointed inwards, turned", mesh.name));
        }
    }
    repair.source = drop_unused_vertices(mesh);
    if (!split.empty()) gather(split, repair.source), repair.source = std::move(split);
    return repair;
}

}  // namespace pellucid
