#ifndef PELLUCID_LIGHT_IRRADIANCE_CELLS_GLSL
#define PELLUCID_LIGHT_IRRADIANCE_CELLS_GLSL

// A world-space cache of irradiance in a spatial hash: Binder, Fricke & Keller, "Massively parallel path space filtering",
// 2019. Samples are added to nodes of grids around the eye, whose spacing grows with the distance to it. Each node keeps six
// sets of sums, of surfaces that face along each axis either way.
#include "gpu/hash.glsl"

// Twin of IrradianceGrid in techniques/irradiance/irradiance_cache.cpp.
struct IrradianceGrid {
    vec4 eye;           // world, m
    float spacing;      // of nodes: in orthographic views m, otherwise m per m from the eye
    float unit;         // W/m2, of which nodes count whole numbers
    uint orthographic;
    uint slot_mask;     // slots are a power of two
    uint lost;          // sums to which a frame found no slot
    uint weight;        // of a sample of this frame
    uint unused[2];
};

struct IrradianceNode {
    uint key;       // 0: none
    uint count;     // samples, each as often as its frame's weight says
    // Signed, 64 bits, the low word first: of irradiance, in units; of the cosines of directions chosen by the environment's
    // light that are open, and of all that lie above the surface, in kCosineUnits.
    uvec2 sums[5];
};

const float kCosineUnits = 1024.0;

const int kCoarserLevels = 3;    // from a level to the one that stands in where there are few samples
const uint kMostProbes = 32u;    // slots that are looked at for a node
const uint kNoNode = 0xffffffffu;

// Level k has nodes 2^k m apart; between whole levels, one of the two is chosen.
float irradiance_level(IrradianceGrid grid, vec3 position) {
    float distance_ = grid.orthographic != 0u ? 1.0 : max(distance(grid.eye.xyz, position), 1e-20);
    return log2(grid.spacing * distance_);
}

// x: of the slot; y: of the node, not 0. `facing`: axis, plus 3 where the surface faces along its negative.
uvec2 node_hash(ivec3 node, int level, uint facing) {
    uvec2 mixed = hash(uvec3(node) + uvec3(uint(level) * 0x9e3779b9u + facing * 0x85ebca6bu)).xy;
    return uvec2(mixed.x, mixed.y | 1u);
}

#endif
