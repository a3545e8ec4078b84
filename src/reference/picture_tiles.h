#pragma once

// Assignment of an image's pixels to threads and packets.

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <glm/glm.hpp>

#include <cstdint>

namespace pellucid::reference {

/// Block of pixels traced together, as square as possible.
inline glm::uvec2 block_size(std::uint32_t packet) {
    switch (packet) {
        case 4:
            return {2, 2};
        case 8:
            return {4, 2};
        case 16:
            return {4, 4};
        default:
            return {1, 1};
    }
}

inline constexpr std::uint32_t kTile = 32;  ///< pixels along a side; a multiple of every block size

inline std::uint32_t tile_count(glm::uvec2 size) {
    const glm::uvec2 tiles = (size + kTile - 1u) / kTile;
    return tiles.x * tiles.y;
}

/// Calls trace_tile(first, end) for the pixels of every tile, `first` inclusive, `end` exclusive. `threads` 0: all
/// cores.
template <class TraceTile>
void for_each_tile(glm::uvec2 size, std::uint32_t threads, const TraceTile& trace_tile) {
    const std::uint32_t columns = (size.x + kTile - 1u) / kTile;
    tbb::task_arena arena(threads > 0 ? int(threads) : tbb::task_arena::automatic);
    arena.execute([&] {
        tbb::parallel_for(0u, tile_count(size), [&](std::uint32_t tile) {
            const glm::uvec2 first = kTile * glm::uvec2(tile % columns, tile / columns);
            trace_tile(first, glm::min(first + kTile, size));
        });
    });
}

}  // namespace pellucid::reference
