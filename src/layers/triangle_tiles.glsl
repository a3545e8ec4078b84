#ifndef PELLUCID_LAYERS_TRIANGLE_TILES_GLSL
#define PELLUCID_LAYERS_TRIANGLE_TILES_GLSL

// The list of tiles of large triangles. Tiles balance the work of neighbouring invocations.
const int kTile = 8;  // texels or pixels along a side

// Shaders that only read the list define PELLUCID_READS_TILES.
#ifdef PELLUCID_READS_TILES
layout(std430, set = 0, binding = 8) readonly buffer Tiles {
    uint tile_count, tiles_reserved[3];
    uvec2 tiles[];  // triangle, tile's x | y << 16
};

// The corner of the tile with the lowest coordinates.
ivec2 tile_corner(uint tile) { return kTile * ivec2(tiles[tile].y & 0xffffu, tiles[tile].y >> 16); }
#else
layout(std430, set = 0, binding = 8) buffer Tiles { uint tile_count, tiles_reserved[3]; uvec2 tiles[]; };

// Lists the tiles of a triangle's box. Tiles beyond the capacity are only counted, and the host enlarges the list.
void cut_into_tiles(uint triangle, ivec2 low, ivec2 high) {
    ivec2 first = low / kTile, count = high / kTile - first + 1;
    uint at = atomicAdd(tile_count, uint(count.x * count.y));
    for (int i = 0; i < count.x * count.y; ++i) {
        ivec2 tile = first + ivec2(i % count.x, i / count.x);
        if (at + uint(i) < tiles.length()) tiles[at + uint(i)] = uvec2(triangle, uint(tile.x) | uint(tile.y) << 16);
    }
}
#endif

#endif
