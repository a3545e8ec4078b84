#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_WALK_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_WALK_GLSL

// The surfaces that paths meet: the maps that are walked, and which of the surfaces in them a path can meet.
// Needs: visibility_bindings.glsl.
#include "layers/surface_map.glsl"
#include "gpu/object_traits.glsl"

layout(std430, set = 0, binding = 3) readonly buffer Traits { uint traits[]; };  // per object
layout(std430, set = 0, binding = 4) readonly buffer Slots { SlotRecord slots[]; };
layout(std430, set = 0, binding = 14) readonly buffer Maps { MapRecord maps[]; };
layout(set = 0, binding = 15) uniform utextureBuffer map_triangles;
layout(set = 0, binding = 29) uniform utextureBuffer map_normals;
layout(set = 0, binding = 16) uniform utextureBuffer texels;
layout(set = 0, binding = 17) uniform utextureBuffer ranges;
layout(set = 0, binding = 28) uniform utextureBuffer records;
layout(set = 0, binding = 22) uniform utextureBuffer pyramid;

#include "techniques/visibility_layers/path_state.glsl"
#include "techniques/visibility_layers/cross_surface.glsl"

// Surfaces for which a volume stands (kReplaced).
const uint kMeetNone = 0u, kMeetEntering = 1u, kMeetAll = 2u;
uint meets_replaced = kMeetNone;

// What is looked for: all surfaces; closed shells of glass alone; what is opaque alone.
const uint kFindAll = 0u, kFindShells = 1u, kFindOpaque = 2u;
uint looks_for = kFindAll;
// While what a path is inside of is not known yet: the slots for which it is.
bool deciding = false;
uint decided[kMediumWords];
uint decided_shell = kNoSlot;  // or this shell alone, which crosses itself: all its surfaces
// Shells that cross themselves which the path has crossed here, by their first slots: their surfaces at this place are
// one, and are not met again.
uint crossed_here[kMediumWords];

void forget_crossed() {
    for (uint w = 0u; w < kMediumWords; ++w) crossed_here[w] = 0u;
}
void note_crossed(uint traits) {
    if (kCrossing && (traits & kCrossesItself) != 0u) crossed_here[slot_of(traits) / 32u] |= 1u << slot_of(traits) % 32u;
}

bool is_in(uint slots_in[kMediumWords], uint slot) { return (slots_in[slot / 32u] >> slot % 32u & 1u) != 0u; }

// Rays enter and leave a shell in turn, so a surface that the path stands on is never met again.
bool can_meet(uint traits, bool leaving, uint triangle) {
    bool closed_shell = (traits & (kKindMask | kClosed)) == (kRefractiveKind | kClosed);
    bool crosses_itself = kCrossing && closed_shell && (traits & kCrossesItself) != 0u;
    if (deciding) {
        if (crosses_itself) return slot_of(traits) == decided_shell;
        return decided_shell == kNoSlot && closed_shell && !is_in(decided, slot_of(traits));
    }
    if (kTouching && looks_for == kFindShells && !closed_shell) return false;
    if (kTouching && looks_for == kFindOpaque && (traits & kKindMask) != kOpaqueKind) return false;
    if (kVolumes && proxy != kSharpInterfaces && (traits & kReplaced) != 0u)
        return meets_replaced == kMeetAll || (meets_replaced == kMeetEntering && !leaving && triangle != standing);
    if (crosses_itself) return triangle != standing && !is_in(crossed_here, slot_of(traits));
    if (!closed_shell) return triangle != standing && !(leaving && (traits & kSingleSided) != 0u);
    return inside_slot(slot_of(traits)) == (leaving != ((traits & kCavity) != 0u));
}

// Whether what fills the place is drawn by a volume.
bool in_replaced(uint body) { return kVolumes && body != kAir && (slots[body].material & kReplacedSolid) != 0u; }

#include "layers/object_walk.glsl"
#include "layers/candidates.glsl"

uint path_number;  // of the path that looks

const float kApart = 16.0;  // coincidences along a ray, which may graze

SurfaceHit find_next(vec3 origin, vec3 direction, float t_min, out float t_end, out bool gave_up, inout uint visits) {
    t_end = kFarthest;
    if (kFoundOnHost) {
        gave_up = false;
        return find_candidate(path_number, origin, direction, t_min);
    }
    return kMapPerMesh ? find_surface_among_objects(origin, direction, t_min, gave_up, visits)
                       : find_surface(maps[0], origin, direction, t_min, t_end, gave_up, visits);
}

// What a shell that crosses itself winds around the start of a ray: all its surfaces on the way are counted.
void find_winding(uint shell, vec3 origin, vec3 direction) {
    decided_shell = shell;
    int winding = 0;
    float t = 0.0, t_end;
    uint visits = 0u;
    for (bool more = true; more;) {
        bool gave_up;
        SurfaceHit hit = find_next(origin, direction, t, t_end, gave_up, visits);
        more = hit.t < kFarthest && hit.t > t;
        if (more) winding += hit.leaving ? 1 : -1;
        t = hit.t;
    }
    for (; winding > 0; --winding) step_across(kCrossesItself | shell << kSlotShift, false);
    for (; winding < 0; ++winding) step_across(kCrossesItself | shell << kSlotShift, true);
    decided_shell = kNoSlot;
}

// Finds what a ray is inside of where it starts: of each slot, the first surface on its way says it.
void find_media(vec3 origin, vec3 direction) {
    for (uint w = 0u; w < kMediumWords; ++w) media[w] = decided[w] = 0u;
    forget_crossed();
    deciding = true;
    uint visits = 0u;
    for (uint n = 0u; n < 32u * kMediumWords; ++n) {
        float t_end;
        bool gave_up;
        SurfaceHit hit = find_next(origin, direction, 0.0, t_end, gave_up, visits);
        if (hit.t == kFarthest) break;
        uint slot = slot_of(hit.traits);
        decided[slot / 32u] |= 1u << slot % 32u;
        set_inside(slot, hit.leaving != ((hit.traits & kCavity) != 0u));
    }
    if (kCrossing) {
        for (uint slot = 0u; slot < slots.length(); ++slot) {
            bool more = (slots[slot].medium & kSameShell) != 0u;
            if (more) find_winding(slot, origin, direction);
            while (more) more = (slots[++slot].medium & kSameShell) != 0u;
        }
    }
    deciding = false;
}

#endif
