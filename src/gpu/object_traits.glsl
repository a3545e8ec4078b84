#ifndef PELLUCID_GPU_OBJECT_TRAITS_GLSL
#define PELLUCID_GPU_OBJECT_TRAITS_GLSL

// Traits of an object, for rays that meet its surface. Twins are in scene_topology.cpp. The traits of a shell are in a
// word per triangle, which is added to the object's word.
const uint kKindMask = 3u, kOpaqueKind = 0u, kThinKind = 1u, kRefractiveKind = 2u;
const uint kClosed = 4u;          // closed shell: rays enter and leave it in turn
const uint kTouchesOthers = 8u;   // another surface may coincide with this one
const uint kCutOut = 16u;         // alpha cuts holes
const uint kReplaced = 32u;       // a volume replaces the object in techniques that draw volumes
const uint kCavity = 64u;         // normals point to the inside of the shell, a cavity of its body
const uint kSingleSided = 128u;   // opaque, and invisible to rays from behind
const uint kCrossesItself = 256u; // closed shell that crosses itself: a ray inside it can enter it again
const uint kReplacedSolid = 0x80000000u;  // in SlotRecord::material: a volume replaces the solid

// A slot is a bit in the state of a path: whether the path is inside a shell. Shells that never overlap share a slot.
const uint kSlotShift = 9u;
uint slot_of(uint traits) { return traits >> kSlotShift; }
bool refractive(uint traits) { return (traits & kKindMask) == kRefractiveKind; }

// Twin of SlotRecord in scene_topology.cpp. The slots of a body are consecutive. Slots of a body come after those of
// the bodies that it displaces. Open surfaces have their own slots, before all others.
struct SlotRecord {
    uint material;  // of the body; with kReplacedSolid
    uint first;     // first slot of the body
    uint count;     // number of the body's slots
    uint medium;    // equal for equal media; with kCavitySlot, kSameShell
};
const uint kCavitySlot = 0x80000000u;
const uint kSameShell = 0x20000000u;  // this slot and the next belong to one shell, which crosses itself

#endif
