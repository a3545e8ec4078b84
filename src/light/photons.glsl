#ifndef PELLUCID_LIGHT_PHOTONS_GLSL
#define PELLUCID_LIGHT_PHOTONS_GLSL

// Photons and the hashed grid in which look-ups find them (photon_store.h).
//
// Every photon has a kernel of its own radius. Levels of the grid have cells four times as wide as the largest radius of
// their photons, and a photon is listed in every cell that its kernel touches, so a look-up reads one cell per level.
// Teschner et al., "Optimized spatial hashing for collision detection of deformable objects", VMV 2003.

#include "gpu/hash.glsl"

// Twin of Photon in photon_store.h.
struct Photon {
    vec3 position;  // m, world
    float radius;   // m, of its kernel
    vec3 flux;      // W
    uint normal;    // of the surface, on the side that the photon came from; packed
    uint level;     // of the grid; kStraightPhoton: not in the grid
    uint object;    // it landed on; PELLUCID_NO_TRIANGLE: it left the scene; kNotYetLanded: as it was sent
    uint texel;     // of the light's view that sent it: no two photons share one
    uint way;       // direction of travel, packed; the lowest bit is kDiffusePhoton
};
const uint kDiffusePhoton = 1u;            // paths that facets send bring its light to facets
const uint kStraightPhoton = 0xffffffffu;  // nothing has bent its path: shadow rays have its light
const uint kNotYetLanded = 0xfffffffeu;
const int kPhotonLevels = 24;

// Twin of PhotonGrid in photon_store.cpp.
struct PhotonGrid {
    float least_radius;  // m, of level 0
    float unit;          // W/m2, of which look-ups count whole numbers
    uint levels;         // a bit for each level that has photons
    uint slot_mask;      // slots are a power of two
};
// Of the cells whose hash is a slot: the first entry, how many entries there are, and how many photons wanted one.
struct PhotonSlot {
    uint first, entries, wanted, reserved;
};

float level_radius(PhotonGrid grid, int level) { return grid.least_radius * uintBitsToFloat(uint(level + 127) << 23); }

uint photon_level(float least_radius, float radius) {
    return uint(clamp(int(ceil(log2(radius / least_radius))), 0, kPhotonLevels - 1));
}

ivec3 photon_cell(PhotonGrid grid, int level, vec3 position) {
    return ivec3(floor(position / (4.0 * level_radius(grid, level))));
}

// x: of the slot, y: tells apart the cells that share it.
uvec2 hash_of_cell(ivec3 cell, int level) {
    return hash(uvec3(cell) + uvec3(level * 0x9e3779b9u)).xy;
}

// Slots in which more photons want an entry keep a share of them, which then count for all: a look-up reads all entries.
const uint kMostEntries = 1024u;

#endif
