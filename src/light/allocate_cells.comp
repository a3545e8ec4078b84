#version 460
// Allocates a range of the list of entries to every slot of the photons' grid, in any order.
#extension GL_GOOGLE_include_directive : require
#include "light/photons.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer PhotonCells { PhotonGrid grid; PhotonSlot slots[]; };
layout(std430, set = 0, binding = 1) buffer PhotonEntries { uint entry_count, entry_reserved[3]; uvec2 entries[]; };
layout(push_constant) uniform Push { uint row; };  // invocations in a row of the dispatch

void main() {
    uint slot = gl_GlobalInvocationID.y * row + gl_GlobalInvocationID.x;
    if (gl_GlobalInvocationID.x >= row || slot > grid.slot_mask || slots[slot].wanted == 0u) return;
    slots[slot].first = atomicAdd(entry_count, slots[slot].wanted);
}
