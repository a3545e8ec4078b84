#ifndef PELLUCID_LIGHT_PHOTON_GRID_GLSL
#define PELLUCID_LIGHT_PHOTON_GRID_GLSL

// Declarations that the passes which sort photons into the grid share.
#extension GL_GOOGLE_include_directive : require
#include "light/photons.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 1) readonly buffer Photons { uint photon_count, photon_reserved[3]; Photon photons[]; };
layout(std430, set = 0, binding = 2) buffer PhotonCells { PhotonGrid grid; PhotonSlot slots[]; };

// The photon of this invocation. False if there is none, or if it does not belong to the grid.
bool own_photon(out uint number, out Photon photon) {
    number = (gl_WorkGroupID.x * gl_NumWorkGroups.y + gl_WorkGroupID.y) * 64u + gl_LocalInvocationID.x;
    if (number >= min(photon_count, uint(photons.length()))) return false;
    photon = photons[number];
    return photon.level != kStraightPhoton;
}

// The box of cells that the photon's kernel touches.
void touched_cells(Photon photon, out ivec3 low, out ivec3 high) {
    low = photon_cell(grid, int(photon.level), photon.position - photon.radius);
    high = photon_cell(grid, int(photon.level), photon.position + photon.radius);
}

#endif
