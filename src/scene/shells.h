#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

/// The connected surfaces of a set of triangles.
///
/// Triangles are joined over welded edges that two of them share. Where more meet at an edge, of two cubes that share
/// one say, those are joined that have material between them, all around the edge. So surfaces that only touch are
/// shells of their own.
struct Shells {
    std::vector<std::uint32_t> of_triangle;  ///< per triangle, the number of its shell, from 0
    /// Per shell: at each edge it has as many triangles on the one side as on the other. So every ray enters it as often
    /// as it leaves it.
    std::vector<char> closed;

    std::uint32_t count() const { return std::uint32_t(closed.size()); }
    bool all_closed() const;
};

/// `weld` has one entry per position (weld_positions()). Triangles between fewer than three welded positions belong to a
/// shell that they touch.
Shells find_shells(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                   std::span<const std::uint32_t> weld);

}  // namespace pellucid
