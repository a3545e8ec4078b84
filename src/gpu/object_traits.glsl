#ifndef PELLUCID_GPU_OBJECT_TRAITS_GLSL
#define PELLUCID_GPU_OBJECT_TRAITS_GLSL

// What a ray has to know of an object whose surface it meets; twin of traits_of() in scene_topology.cpp.
const uint kKindMask = 3u, kOpaqueKind = 0u, kThinKind = 1u, kRefractiveKind = 2u;
const uint kClosed = 4u;          // bounds a solid: rays enter and leave it in turn
const uint kTouchesOthers = 8u;   // its box meets another object's
const uint kCutOut = 16u;         // has holes by its alpha
const uint kReplaced = 32u;       // a volume stands for it, where those are drawn
const uint kReplacedSolid = 0x80000000u;  // the same, of a rank, beside its material

// Of overlapping solids the one of the higher rank fills the place.
uint rank_of(uint traits) { return traits >> 8; }
bool refractive(uint traits) { return (traits & kKindMask) == kRefractiveKind; }

#endif
