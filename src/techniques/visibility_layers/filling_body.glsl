#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_FILLING_BODY_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_FILLING_BODY_GLSL

// The medium of a path. Needs: path_state.glsl, materials, slots (SlotRecord[]).
#include "gpu/object_traits.glsl"

// The body that fills the path's position, by its first slot: of the bodies around the path, the body that displaces
// the others.
uint filling_body(Media media) {
    for (uint w = kMediumWords; w-- > 0u;) {
        uint bits = media.words[w];
        while (bits != 0u) {
            uint slot = w * 32u + uint(findMSB(bits));
            if (!kManySlots) return slot;
            SlotRecord record = slots[slot];
            int winding = 0;
            for (uint s = record.first; s < record.first + record.count; ++s)
                if (is_inside(media, s)) winding += (slots[s].medium & kCavitySlot) != 0u ? -1 : 1;
            if (winding > 0) return record.first;
            // Continue with the next body, whose slots are lower.
            bits = record.first <= w * 32u ? 0u : bits & ((1u << (record.first - w * 32u)) - 1u);
        }
    }
    return kAir;
}

uint body_of(uint traits) {
    uint slot = slot_of(traits);
    return kManySlots ? slots[slot].first : slot;
}

// Equal media of two bodies that touch have no interface.
bool is_interface(uint before, uint beyond) {
    if (before == beyond) return false;
    if (before == kAir || beyond == kAir) return true;
    return ((slots[before].medium ^ slots[beyond].medium) & ~(kCavitySlot | kSameShell)) != 0u;
}

MaterialRecord filling_material(uint body) {
    return materials[kOneObject ? objects[0].material : slots[body].material & ~kReplacedSolid];
}

// Indices per channel; equal without dispersion.
vec3 filling_iors(uint body) {
    if (body == kAir) return vec3(1.0);
    MaterialRecord material = filling_material(body);
    return kDispersive ? ior_per_channel(material.ior, material.dispersion) : vec3(material.ior);
}

#endif
