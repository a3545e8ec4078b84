#include "scene/repair_solid.h"

#include "scene/mesh_edges.h"
#include "scene/mesh_repair.h"
#include "scene/orient_shells.h"
#include "scene/shells.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

namespace pellucid {
namespace {

const char* plural(std::size_t count) { return count == 1 ? "" : "s"; }

/// Merges welded vertices within the tolerance, if that leaves fewer open edges. Returns the number of merged
/// vertices.
std::size_t join_near_vertices(Mesh& mesh, std::vector<std::uint32_t>& weld) {
    const std::uint64_t open = count_edges(mesh.triangles, weld).boundary;
    if (open == 0) return 0;
    const float tolerance = weld_tolerance(mesh.positions);
    if (!(tolerance > 0.0f)) return 0;
    std::vector<char> at_open_edge(weld.size(), 0);
    for_each_edge(sorted_half_edges(mesh.triangles, weld), [&](std::span<const HalfEdge> edge) {
        if (edge.size() == 1) at_open_edge[edge[0].ends >> 32] = at_open_edge[std::uint32_t(edge[0].ends)] = 1;
    });
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < weld.size(); ++v)
        if (at_open_edge[v] != 0) vertices.push_back(v);
    DisjointSets sets = near_vertices(mesh.positions, vertices, tolerance);
    std::vector<std::uint32_t> nearer = weld;
    for (std::uint32_t& v : nearer) v = sets.root(v);
    if (count_edges(mesh.triangles, nearer).boundary >= open) return 0;
    std::size_t moved = 0;
    for (std::uint32_t v = 0; v < weld.size(); ++v) {
        moved += weld[v] == v && nearer[v] != v;
        mesh.positions[v] = mesh.positions[nearer[v]];
    }
    weld = std::move(nearer);
    return moved;
}

struct TwiceDrawn {
    std::size_t alike = 0;    ///< removed duplicates with equal winding
    std::size_t walls = 0;    ///< removed pairs with opposite winding inside a solid
    std::size_t doubled = 0;  ///< removed back sides of double-sided triangles
};

/// Triangles with the same welded vertices, by winding.
struct SameTriangles {
    std::array<std::vector<std::uint32_t>, 2> wound;
    std::size_t pairs() const { return std::min(wound[0].size(), wound[1].size()); }
};

/// Groups of triangles that occur more than once.
std::vector<SameTriangles> same_triangles(const std::vector<glm::uvec3>& triangles,
                                          const std::vector<std::uint32_t>& weld) {
    std::vector<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> keys;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        std::array<std::uint32_t, 3> key{weld[triangles[t].x], weld[triangles[t].y], weld[triangles[t].z]};
        // Rotate the key to start at its least vertex; the other two then tell the winding.
        std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
        if (key[0] == key[1] || key[1] == key[2] || key[2] == key[0]) continue;
        const bool turned = key[1] > key[2];
        if (turned) std::swap(key[1], key[2]);
        keys.emplace_back(key, t << 1 | std::uint32_t(turned));
    }
    std::sort(keys.begin(), keys.end());
    std::vector<SameTriangles> result;
    for (std::size_t begin = 0, end; begin < keys.size(); begin = end) {
        for (end = begin; end < keys.size() && keys[end].first == keys[begin].first;) ++end;
        if (end - begin < 2) continue;
        result.emplace_back();
        for (std::size_t i = begin; i < end; ++i)
            result.back().wound[keys[i].second & 1].push_back(keys[i].second >> 1);
    }
    return result;
}

std::vector<glm::uvec3> kept(const std::vector<glm::uvec3>& triangles, const std::vector<char>& gone) {
    std::vector<glm::uvec3> rest;
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (gone[t] == 0) rest.push_back(triangles[t]);
    return rest;
}

/// Number of edges with different counts of triangles in the two directions.
std::size_t open_edges(const std::vector<glm::uvec3>& triangles, const std::vector<std::uint32_t>& weld) {
    std::size_t count = 0;
    for_each_edge(sorted_half_edges(triangles, weld), [&](std::span<const HalfEdge> edge) {
        const auto forward = std::count_if(edge.begin(), edge.end(), [](const HalfEdge& side) { return side.forward; });
        count += 2 * std::size_t(forward) != edge.size();
    });
    return count;
}

TwiceDrawn leave_out_twice_drawn(Mesh& mesh, const std::vector<std::uint32_t>& weld) {
    const std::vector<SameTriangles> all = same_triangles(mesh.triangles, weld);
    if (all.empty()) return {};
    TwiceDrawn result;
    // Pairs with opposite winding are walls inside a solid if their removal leaves a closed surface.
    std::vector<char> gone(mesh.triangles.size(), 0);
    std::size_t pairs = 0;
    for (const SameTriangles& same : all) {
        for (std::size_t i = 0; i < same.pairs(); ++i) gone[same.wound[0][i]] = gone[same.wound[1][i]] = 1;
        pairs += same.pairs();
    }
    if (pairs > 0) {
        const std::vector<glm::uvec3> rest = kept(mesh.triangles, gone);
        if (!rest.empty() && open_edges(rest, weld) == 0) {
            result.walls = 2 * pairs;
        } else {
            std::fill(gone.begin(), gone.end(), 0);
            for (const SameTriangles& same : all) {
                if (same.pairs() == 0) continue;
                const int first = same.wound[0].front() < same.wound[1].front() ? 0 : 1;
                for (const std::uint32_t t : same.wound[1 - first]) gone[t] = 1;
                result.doubled += same.wound[1 - first].size();
            }
        }
        mesh.triangles = kept(mesh.triangles, gone);
    }
    // Keep one triangle of equal winding, unless the duplicates close the surface elsewhere.
    std::vector<char> alike(mesh.triangles.size(), 0);
    for (const SameTriangles& same : same_triangles(mesh.triangles, weld))
        for (const std::vector<std::uint32_t>& wound : same.wound)
            for (std::size_t i = 1; i < wound.size(); ++i) alike[wound[i]] = 1;
    const auto more = std::size_t(std::count(alike.begin(), alike.end(), char(1)));
    if (more == 0) return result;
    std::vector<glm::uvec3> once = kept(mesh.triangles, alike);
    if (open_edges(once, weld) > open_edges(mesh.triangles, weld)) return result;
    mesh.triangles = std::move(once);
    result.alike = more;
    return result;
}

/// Makes the winding consistent in each orientable surface by reversing the minority of its triangles. Returns the
/// number of reversed triangles.
std::size_t wind_alike(Mesh& mesh, const std::vector<std::uint32_t>& weld) {
    const std::vector<HalfEdge> sides = sorted_half_edges(mesh.triangles, weld);
    struct Neighbour {
        std::uint32_t triangle;
        bool alike;
    };
    std::vector<std::vector<Neighbour>> neighbours;
    bool all_alike = true;
    for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
        all_alike = all_alike && (edge.size() != 2 || edge[0].forward != edge[1].forward);
    });
    if (all_alike) return 0;
    neighbours.resize(mesh.triangles.size());
    for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
        if (edge.size() != 2) return;
        const bool alike = edge[0].forward != edge[1].forward;
        neighbours[edge[0].triangle].push_back({edge[1].triangle, alike});
        neighbours[edge[1].triangle].push_back({edge[0].triangle, alike});
    });
    constexpr char kUnseen = -1;
    std::vector<char> turns(mesh.triangles.size(), kUnseen);
    std::size_t turned = 0;
    for (std::uint32_t start = 0; start < mesh.triangles.size(); ++start) {
        if (turns[start] != kUnseen) continue;
        std::vector<std::uint32_t> surface{start};
        turns[start] = 0;
        bool orientable = true;
        for (std::size_t i = 0; i < surface.size(); ++i) {
            for (const Neighbour& next : neighbours[surface[i]]) {
                const char wanted = next.alike ? turns[surface[i]] : char(1 - turns[surface[i]]);
                if (turns[next.triangle] == kUnseen) {
                    turns[next.triangle] = wanted;
                    surface.push_back(next.triangle);
                }
                orientable = orientable && turns[next.triangle] == wanted;
            }
        }
        if (!orientable) continue;  // a one-sided surface has no inside
        const auto ones =
            std::size_t(std::count_if(surface.begin(), surface.end(), [&](auto t) { return turns[t] == 1; }));
        const char fewer = 2 * ones <= surface.size() ? 1 : 0;
        for (const std::uint32_t t : surface) {
            if (turns[t] != fewer) continue;
            std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
            ++turned;
        }
    }
    return turned;
}

/// Reverses normals that oppose all triangles around them. Returns their count.
std::size_t turn_inward_normals(Mesh& mesh) {
    if (mesh.normals.empty()) return 0;
    std::vector<glm::dvec3> outward(mesh.positions.size(), glm::dvec3(0.0));
    for (const glm::uvec3 t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const glm::dvec3 n = glm::cross(b - a, c - a);
        for (int k = 0; k < 3; ++k) outward[t[k]] += n;
    }
    std::size_t turned = 0;
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
        if (!(glm::dot(outward[v], glm::dvec3(mesh.normals[v])) < 0.0)) continue;
        turn_normal(mesh, v);
        ++turned;
    }
    return turned;
}

void warn_of_twice_drawn(const TwiceDrawn& twice, const std::string& name, Warnings& warnings) {
    const auto warn = [&](std::size_t count, const char* what) {
        if (count > 0) warnings.add(fmt::format("{}: {} triangle{} {}, left out", name, count, plural(count), what));
    };
    warn(twice.alike, "drawn more than once");
    warn(twice.walls, "of walls inside the solid");
    warn(twice.doubled, "that are the other sides of triangles");
}

void warn_of_edges(const EdgeCounts& edges, bool all_closed, const std::string& name, Warnings& warnings) {
    if (!all_closed && edges.boundary + edges.non_manifold > 0)
        warnings.add(
            fmt::format("{}: {} boundary edges, {} non-manifold edges: not a closed solid, "
                        "refraction there is approximate",
                        name, edges.boundary, edges.non_manifold));
    if (edges.miswound > 0)
        warnings.add(
            fmt::format("{}: {} edges between triangles wound against each other: inside "
                        "and outside are mixed up there",
                        name, edges.miswound));
}

/// Joins the parts into one mesh; take_apart() is the inverse.
Mesh joined(const std::vector<Mesh*>& parts) {
    Mesh whole;
    const bool normals =
        std::none_of(parts.begin(), parts.end(), [](const Mesh* part) { return part->normals.empty(); });
    for (const Mesh* part : parts) {
        const auto first = std::uint32_t(whole.positions.size());
        whole.positions.insert(whole.positions.end(), part->positions.begin(), part->positions.end());
        if (normals) whole.normals.insert(whole.normals.end(), part->normals.begin(), part->normals.end());
        for (const glm::uvec3 t : part->triangles) whole.triangles.push_back(t + first);
    }
    return whole;
}

void take_apart(const Mesh& whole, const std::vector<Mesh*>& parts) {
    std::uint32_t first = 0;
    std::vector<std::uint32_t> ends;
    for (Mesh* part : parts) {
        const auto count = std::uint32_t(part->positions.size());
        std::copy_n(whole.positions.begin() + first, count, part->positions.begin());
        for (std::uint32_t v = 0; v < count && !whole.normals.empty(); ++v)
            if (glm::dot(whole.normals[first + v], part->normals[v]) < 0.0f) turn_normal(*part, v);
        part->triangles.clear();
        first += count;
        ends.push_back(first);
    }
    for (const glm::uvec3 t : whole.triangles) {
        const auto part = std::size_t(std::upper_bound(ends.begin(), ends.end(), t.x) - ends.begin());
        parts[part]->triangles.push_back(t - (part > 0 ? ends[part - 1] : 0u));
    }
}

}  // namespace

SolidRepair repair_solid(Mesh& mesh, bool deforms, Warnings& warnings) {
    std::vector<std::uint32_t> weld = weld_positions(mesh.positions);
    if (const std::size_t moved = deforms ? 0 : join_near_vertices(mesh, weld))
        warnings.add(fmt::format("{}: {} vert{} all but at the same place as others, joined", mesh.name, moved,
                                 moved == 1 ? "ex" : "ices"));
    const TwiceDrawn twice = leave_out_twice_drawn(mesh, weld);
    warn_of_twice_drawn(twice, mesh.name, warnings);
    const std::size_t rewound = wind_alike(mesh, weld);
    if (rewound > 0)
        warnings.add(fmt::format("{}: {} triangle{} wound against their neighbours, turned", mesh.name, rewound,
                                 plural(rewound)));

    // Count edges before dropping triangles: a triangle squeezed to a line leaves no gap, but its neighbours no longer
    // share an edge.
    const Shells shells = find_shells(mesh.positions, mesh.triangles, weld);
    warn_of_edges(count_edges(mesh.triangles, weld), shells.all_closed(), mesh.name, warnings);
    SolidRepair repair;
    const bool one_by_one = !deforms && shells.count() > 1;  // morph targets have one sign for all normals
    if (one_by_one) {
        const TurnedShells turned = orient_shells(mesh, shells);
        if (turned.closed > 0)
            warnings.add(
                fmt::format("{}: {} of {} shells wound inside out, turned", mesh.name, turned.closed, shells.count()));
        if (turned.open) warnings.add(fmt::format("{}: open surfaces were wound inside out, turned", mesh.name));
    }
    if (const std::size_t dropped = deforms ? 0 : drop_zero_area_triangles(mesh))
        warnings.add(fmt::format("{}: {} triangle{} without area left out", mesh.name, dropped, plural(dropped)));
    // An open sheet has no meaningful sign of volume.
    if (const SignedVolume volume = signed_volume(mesh); !one_by_one && volume.value < 0.0 && volume.meaningful()) {
        turn_inside_out(mesh);
        repair.inside_out = true;
        warnings.add(fmt::format("{}: was wound inside out, turned", mesh.name));
    }
    if (!deforms && rewound + twice.doubled > 0) turn_inward_normals(mesh);
    return repair;
}

void repair_solid_in_parts(const std::vector<Mesh*>& parts, const std::string& name, Warnings& warnings) {
    Mesh whole = joined(parts);
    whole.name = name;
    const SolidRepair repair = repair_solid(whole, false, warnings);
    if (repair.inside_out && whole.normals.empty())  // parts that have normals
        for (Mesh* part : parts)
            for (std::size_t v = 0; v < part->normals.size(); ++v) turn_normal(*part, v);
    take_apart(whole, parts);
}

}  // namespace pellucid
