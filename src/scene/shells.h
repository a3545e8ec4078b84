#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

/// The connected surfaces of a set of triangles.
///
/// Triangles are joined across welded edges that two of them share. Where more triangles meet at an edge, for example
/// of two cubes that share it, those with material between them are joined. Surfaces that only touch are thus separate
/// shells.
struct Shells {
    std::vector<std::uint32_t> of_triangle;  ///< per triangle, the index of its shell
    /// Per shell: true if each edge has equally many triangles in both directions. Every ray then enters the shell as
    /// often as it leaves it.
    std::vector<char> closed;

    std::uint32_t count() const { return std::uint32_t(closed.size()); }
    bool all_closed() const;
};

/// `weld` has one entry per position (weld_positions()). Triangles with fewer than three distinct welded positions
/// belong to a shell that they touch.
Shells find_shells(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                   std::span<const std::uint32_t> weld);

}  // namespace pellucid
