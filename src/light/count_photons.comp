#version 460
// Counts the photons of every slot of the grid.
#extension GL_GOOGLE_include_directive : require
#include "light/photon_grid.glsl"

void main() {
    uint number;
    Photon photon;
    if (!own_photon(number, photon)) return;
    uint bit = 1u << photon.level;
    if ((grid.levels & bit) == 0u) atomicOr(grid.levels, bit);
    ivec3 low, high, cell;
    touched_cells(photon, low, high);
    for (cell.z = low.z; cell.z <= high.z; ++cell.z)
        for (cell.y = low.y; cell.y <= high.y; ++cell.y)
            for (cell.x = low.x; cell.x <= high.x; ++cell.x)
                atomicAdd(slots[hash_of_cell(cell, int(photon.level)).x & grid.slot_mask].wanted, 1u);
}
