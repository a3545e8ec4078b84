#version 460
// Adds every photon to the slots of the cells that its kernel touches. Crowded slots keep a share of their photons. A
// hash of the photon selects them, so the selection does not depend on their order.
#extension GL_GOOGLE_include_directive : require
#include "light/photon_grid.glsl"

layout(std430, set = 0, binding = 3) buffer PhotonEntries { uint entry_count, entry_reserved[3]; uvec2 entries[]; };
layout(push_constant) uniform Push { uint sample_index; };

bool keeps(uint wanted, uint texel) {
    if (wanted <= kMostEntries) return true;
    float chance = float(hash_of_cell(ivec3(texel, sample_index, 77), 0).x >> 8u) / 16777216.0;
    return chance * float(wanted) < float(kMostEntries);
}

void main() {
    uint number;
    Photon photon;
    if (!own_photon(number, photon)) return;
    ivec3 low, high, cell;
    touched_cells(photon, low, high);
    for (cell.z = low.z; cell.z <= high.z; ++cell.z)
        for (cell.y = low.y; cell.y <= high.y; ++cell.y)
            for (cell.x = low.x; cell.x <= high.x; ++cell.x) {
                uvec2 hash = hash_of_cell(cell, int(photon.level));
                uint slot = hash.x & grid.slot_mask;
                if (!keeps(slots[slot].wanted, photon.texel)) continue;
                uint at = slots[slot].first + atomicAdd(slots[slot].entries, 1u);
                if (at < uint(entries.length())) entries[at] = uvec2(number, hash.y);
            }
}
