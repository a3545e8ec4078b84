#ifndef PELLUCID_LIGHT_IRRADIANCE_CELLS_GLSL
#define PELLUCID_LIGHT_IRRADIANCE_CELLS_GLSL

// A world-space cache of irradiance in a spatial hash: Binder, Fricke & Keller, "Massively parallel path space
// filtering", 2019. Samples are added to nodes of grids, whose spacing grows with the distance from the eye. Surfaces
// that face along the positive and the negative direction of each axis have separate nodes, six per position.
#include "gpu/hash.glsl"

// Twin of IrradianceGrid in techniques/irradiance/irradiance_cache.cpp.
struct IrradianceGrid {
    vec4 eye;           // world, m
    float spacing;      // of nodes: m in orthographic views, otherwise m per m of distance from the eye
    float unit;         // W/m2 per unit of the nodes' sums
    uint orthographic;
    uint slot_mask;     // number of slots, a power of two, minus 1
    uint lost;          // number of sums without a slot in a frame
    uint weight;        // of a sample in this frame
    uint unused[2];
};

struct IrradianceNode {
    uint key;       // 0: none
    uint count;     // sum of the samples' weights
    // Signed 64-bit sums, the low word first. 0..2: irradiance, in IrradianceGrid::unit. 3, 4: cosines of directions
    // sampled by the environment's light, in units of 1 / kCosineUnits; 3: unoccluded, 4: all above the surface.
    uvec2 sums[5];
};

const float kCosineUnits = 1024.0;

const int kCoarserLevels = 3;    // number of levels up to the substitute level for nodes with few samples
const uint kMostProbes = 32u;    // most slots that are searched for a node
const uint kNoNode = 0xffffffffu;

// The level at a position, not a whole number. Nodes of level k are 2^k m apart.
float irradiance_level(IrradianceGrid grid, vec3 position) {
    float distance_ = grid.orthographic != 0u ? 1.0 : max(distance(grid.eye.xyz, position), 1e-20);
    return log2(grid.spacing * distance_);
}

// Hashes of a node: x selects the slot; y identifies the node and is not 0. `facing`: axis 0..2, plus 3 for surfaces
// that face along its negative direction.
uvec2 node_hash(ivec3 node, int level, uint facing) {
    uvec2 mixed = hash(uvec3(node) + uvec3(uint(level) * 0x9e3779b9u + facing * 0x85ebca6bu)).xy;
    return uvec2(mixed.x, mixed.y | 1u);
}

#endif
