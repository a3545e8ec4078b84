#ifndef PELLUCID_LIGHT_PHOTON_LOOKUP_GLSL
#define PELLUCID_LIGHT_PHOTON_LOOKUP_GLSL

// Light that photons bring to a place on a surface.
// Needs: light/photon_reflection.glsl, or another vec3 photon_reflection(Photon, PhotonReceiver).
#include "gpu/octahedral.glsl"
#include "light/photons.glsl"

layout(std430, set = 0, binding = 51) readonly buffer PhotonCells { PhotonGrid photon_grid; PhotonSlot photon_slots[]; };
layout(std430, set = 0, binding = 52) readonly buffer PhotonEntries {
    uint photon_entry_count, photon_entry_reserved[3];
    uvec2 photon_entries[];
};
layout(std430, set = 0, binding = 53) readonly buffer Photons {
    uint photon_count, photon_reserved[3];
    Photon photons[];
};

// Sums whole numbers of PhotonGrid::unit of either sign in 64 bits: the order of what is added does not matter.
void add_units(float units, inout uvec2 sum) {
    float size = abs(units);
    uint high = uint(size / 4294967296.0), low = uint(size - float(high) * 4294967296.0), carry;
    if (units < 0.0) {
        low = ~low + 1u;
        high = ~high + (low == 0u ? 1u : 0u);
    }
    sum.x = uaddCarry(sum.x, low, carry);
    sum.y += high + carry;
}

// Silverman's kernel K2 (1986, equation 4.5) at a share of the radius, squared; per area of the kernel's disc.
float photon_kernel(float squared) { return 3.0 * (1.0 - squared) * (1.0 - squared); }

// Sum over the photons around a place with that unit normal, on its side of the surface, each as the receiver reflects it.
vec3 photon_light(vec3 position, vec3 normal, PhotonReceiver receiver) {
    uvec2 sums[3] = uvec2[3](uvec2(0u), uvec2(0u), uvec2(0u));
    for (uint levels = photon_grid.levels; levels != 0u; levels &= levels - 1u) {
        int level = findLSB(levels);
        uvec2 hash = hash_of_cell(photon_cell(photon_grid, level, position), level);
        PhotonSlot slot = photon_slots[hash.x & photon_grid.slot_mask];
        // Entries of a crowded slot stand for all that wanted one there.
        float share = slot.wanted > kMostEntries ? float(slot.wanted) / float(kMostEntries) : 1.0;
        for (uint i = slot.first; i < slot.first + slot.entries; ++i) {
            uvec2 entry = photon_entries[i];
            if (entry.y != hash.y) continue;
            Photon photon = photons[entry.x];
            vec3 apart = photon.position - position;
            float squared = dot(apart, apart) / (photon.radius * photon.radius);
            if (photon.level != uint(level) || squared >= 1.0 || dot(unpack_unit_vector(photon.normal), normal) < 0.5) continue;
            vec3 units = photon.flux * (share * photon_kernel(squared) / (3.14159265 * photon.radius * photon.radius * photon_grid.unit));
            units *= photon_reflection(photon, receiver);
            for (int c = 0; c < 3; ++c) add_units(units[c], sums[c]);
        }
    }
    vec3 sum;
    for (int c = 0; c < 3; ++c) sum[c] = float(int(sums[c].y)) * 4294967296.0 + float(sums[c].x);
    return photon_grid.unit * sum;
}

#endif
