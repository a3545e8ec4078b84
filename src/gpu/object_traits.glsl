#ifndef PELLUCID_GPU_OBJECT_TRAITS_GLSL
#define PELLUCID_GPU_OBJECT_TRAITS_GLSL

// What a ray has to know of an object whose surface it meets; twin of traits_of() in scene_topology.cpp. What the shells
// of a mesh have of their own is in a word per triangle, which is added to the object's.
const uint kKindMask = 3u, kOpaqueKind = 0u, kThinKind = 1u, kRefractiveKind = 2u;
const uint kClosed = 4u;          // of a closed shell: rays enter and leave it in turn
const uint kTouchesOthers = 8u;   // another surface may lie at the same place
const uint kCutOut = 16u;         // has holes by its alpha
const uint kReplaced = 32u;       // a volume stands for it, where those are drawn
const uint kCavity = 64u;         // inside is where the normals point: counts against its body
const uint kSingleSided = 128u;   // opaque, and not there for rays that come from behind
const uint kCrossesItself = 256u; // of a closed shell: surfaces that lead in are met in it, too
const uint kReplacedSolid = 0x80000000u;  // a volume stands for it: of a slot, beside its material

// A place in the state of a path for whether it is inside a shell. Shells that never overlap share one.
const uint kSlotShift = 9u;
uint slot_of(uint traits) { return traits >> kSlotShift; }
bool refractive(uint traits) { return (traits & kKindMask) == kRefractiveKind; }

// Twin of SlotRecord in scene_topology.cpp. A body has slots one after the other; those of bodies that displace others
// come later. Open surfaces have slots of their own, before all others.
struct SlotRecord {
    uint material;  // of the body; and kReplacedSolid
    uint first;     // slot of its body
    uint count;     // of its body's slots
    uint medium;    // equal for equal media; and kCavitySlot, kSameShell
};
const uint kCavitySlot = 0x80000000u;
const uint kSameShell = 0x20000000u;  // this slot and the next are of one shell, which crosses itself

#endif
