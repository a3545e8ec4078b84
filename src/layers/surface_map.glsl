#ifndef PELLUCID_LAYERS_SURFACE_MAP_GLSL
#define PELLUCID_LAYERS_SURFACE_MAP_GLSL

// Records of a surface map (surface_map.h).
#extension GL_EXT_samplerless_texture_functions : require
#include "gpu/structs.h"

// Twin of MapRecord in map_building.h.
struct MapRecord {
    mat4 map_from_space;   // (X, Y, Q, W)
    float near_w;
    uint width, height;    // texels
    uint log2_width, log2_height;  // of the pyramid's finest level
    uint first_head, first_node;   // first texel and node, in buffers that several maps share
    uint first_triangle;           // of the map's mesh, over all meshes; 0 for a map of all objects
};

// A triangle in map_triangles is three vec4: its first corner, and the edges from there to the second and third corner.
// Its vertex normals in map_normals are three more vec4, outward, in the same space.

// A record states that a triangle crosses the texel. The depths of all records lie in a separate list, as
// lowest | highest << 16. Rays read four depth ranges at a time; unused ranges are kNoRange.
struct SurfaceRecord {
    uint triangle;
    uint traits;    // of object and shell (object_traits.glsl); in the map of a mesh, of the shell only
};
// Range of a texel's records. `first` is a multiple of kRangeBlock.
struct TexelRecords {
    uint first, count;
};
const uint kRangeBlock = 4u;
const uint kNoTexel = 0xffffffffu;

// Depths are quantised to 16 bits.
const float kDepthSteps = 65535.0;
const uint kNoRange = 0x0000ffffu;  // an empty range: it ends before it starts

uint pack_range(float low, float high) {
    uint l = uint(clamp(floor(low * kDepthSteps), 0.0, kDepthSteps));
    uint h = uint(clamp(ceil(high * kDepthSteps), 0.0, kDepthSteps));
    return l | h << 16;
}

// First node of a level of the pyramid. Sizes fall by four, so the starts follow the digits of 1/3 in base four.
int level_start(MapRecord map, int level) {
    int log2_area = int(map.log2_width + map.log2_height);
    int starts = ((log2_area & 1) == 0 ? 0x55555555 : 0x2aaaaaaa) & ((2 << log2_area) - 1);
    return int(map.first_node) + (starts & ~((4 << log2_area >> 2 * level) - 1));
}

// Index of a texel along a Z curve. So blocks of texels lie together in memory, and node i / 4 is the parent of node i.
int texel_order(MapRecord map, ivec2 texel) {
    int side = int(min(map.log2_width, map.log2_height));
    ivec2 block = texel >> side;
    ivec2 spread = texel & ((1 << side) - 1);
    spread = (spread | spread << 8) & 0x00ff00ff;
    spread = (spread | spread << 4) & 0x0f0f0f0f;
    spread = (spread | spread << 2) & 0x33333333;
    spread = (spread | spread << 1) & 0x55555555;
    return (block.x | block.y) << 2 * side | spread.y << 1 | spread.x;
}

// The node of a level that contains a texel.
int node_index(MapRecord map, int level, int order) { return level_start(map, level) + (order >> 2 * level); }

uint map_levels(MapRecord map) { return min(map.log2_width, map.log2_height) + 1u; }

// Inserts a range into up to four ranges, sorted by their start. A fifth range merges the two with the smallest gap.
void insert_range(inout uvec4 ranges, uint range) {
    if ((range & 0xffffu) > (range >> 16)) return;
    uint sorted[5] = uint[5](ranges.x, ranges.y, ranges.z, ranges.w, range);
    for (int i = 4; i > 0; --i) {
        if ((sorted[i] & 0xffffu) < (sorted[i - 1] & 0xffffu)) {
            uint lower = sorted[i];
            sorted[i] = sorted[i - 1];
            sorted[i - 1] = lower;
        }
    }
    if (sorted[4] != kNoRange) {
        int closest = 0, smallest = 0x7fffffff;
        for (int i = 0; i < 4; ++i) {
            int gap = int(sorted[i + 1] & 0xffffu) - int(sorted[i] >> 16);
            if (gap < smallest) {
                smallest = gap;
                closest = i;
            }
        }
        for (int i = 0; i < 4; ++i) {
            if (i == closest) sorted[i] = (sorted[i] & 0xffffu) | max(sorted[i] >> 16, sorted[i + 1] >> 16) << 16;
            else if (i > closest) sorted[i] = sorted[i + 1];
        }
    }
    ranges = uvec4(sorted[0], sorted[1], sorted[2], sorted[3]);
}

#endif
