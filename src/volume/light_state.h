// Counters of the wavefront tracer on the device. C++ and GLSL share the struct; its layout follows gpu/structs.h.
#ifndef PELLUCID_VOLUME_LIGHT_STATE_H
#define PELLUCID_VOLUME_LIGHT_STATE_H

#ifdef __cplusplus
#include <cstdint>
namespace pellucid::gpu {
// NOLINTBEGIN(readability-identifier-naming): GLSL's names
using uint = std::uint32_t;
// NOLINTEND(readability-identifier-naming)
#endif

// Fates of light: indices into LightState::power.
#define PELLUCID_LIGHT_EMITTED 0u
#define PELLUCID_LIGHT_ARRIVED 1u    // on opaque surfaces
#define PELLUCID_LIGHT_MISSED 2u     // left all volumes, met no surface
#define PELLUCID_LIGHT_ABSORBED 3u   // absorbed or scattered
#define PELLUCID_LIGHT_TURNED 4u     // dropped at a fold
#define PELLUCID_LIGHT_WEAK 5u       // dropped as too weak
#define PELLUCID_LIGHT_LEFT 6u       // still in flight when the rounds ended
#define PELLUCID_LIGHT_REFLECTED 7u  // reflected by surfaces (Fresnel), and not followed
#define PELLUCID_LIGHT_FATES 8u

struct LightState {
    uint power[PELLUCID_LIGHT_FATES * 6u];  // wide counters, three colours each
    uint kept, extra;                       // patches for the next round, from the front and the back of the list
    uint in_kept, in_extra;                 // patches of this round
    uint landed, landing;                   // patches to land on surfaces: for the next round, in this round
    uint peak;                              // most patches at once
    uint rounds;                            // number of rounds that had patches
    uint refused;                           // splits and reflections beyond the capacity
    uint left;                              // patches in flight when the rounds ended
    uint splits;
    uint shown;  // patches for View::kWavefront, including those beyond the capacity
};

#ifdef __cplusplus
static_assert(sizeof(LightState) == 24 * 8 + 48);
}  // namespace pellucid::gpu
#endif

#endif
