#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_WALK_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_WALK_GLSL

// The surfaces that paths meet: who finds them, and which of them a path can meet. Programs that define PELLUCID_RAY_QUERY
// walk no maps: the device's ray tracing finds surfaces.
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
// What is looked for: all surfaces; closed shells of glass alone; what is opaque alone.
const uint kFindAll = 0u, kFindShells = 1u, kFindOpaque = 2u;

// A path that looks for a surface.
struct Search {
    Media media;         // of the path,
    uint standing;       // the triangle on which it stands,
    uint pixel;          // its number
    uint wanted;         // kFindAll, ...
    uint replaced;       // kMeetNone, ...
    Media crossed_here;  // shells that cross themselves which it has crossed here, by their first slots: their surfaces at
                         // this place are one, and are not met again
    bool deciding;       // what it is inside of is not known yet,
    Media decided;       // but of these slots,
    uint decided_shell;  // or it is looked for of this shell alone, which crosses itself: all its surfaces
    float limit;         // m, how far it looks
    uint visits, most_visits;  // nodes and records looked at
    bool gave_up;              // as there were too many
    uint object_traits, first_triangle;  // of the object whose maps are walked: what its records leave out
};

void note_crossed(inout Search search, uint traits) {
    if (kCrossing && (traits & kCrossesItself) != 0u) set_inside(search.crossed_here, slot_of(traits), true);
}

// Rays enter and leave a shell in turn, so a surface that the path stands on is never met again.
bool can_meet(Search search, uint traits, bool leaving, uint triangle) {
    bool closed_shell = (traits & (kKindMask | kClosed)) == (kRefractiveKind | kClosed);
    bool crosses_itself = kCrossing && closed_shell && (traits & kCrossesItself) != 0u;
    if (search.deciding) {
        if (crosses_itself) return slot_of(traits) == search.decided_shell;
        return search.decided_shell == kNoSlot && closed_shell && !is_inside(search.decided, slot_of(traits));
    }
    if (kTouching && search.wanted == kFindShells && !closed_shell) return false;
    if (kTouching && search.wanted == kFindOpaque && (traits & kKindMask) != kOpaqueKind) return false;
    bool elsewhere = triangle != search.standing;
    if (kVolumes && proxy != kSharpInterfaces && (traits & kReplaced) != 0u)
        return search.replaced == kMeetAll || (search.replaced == kMeetEntering && !leaving && elsewhere);
    if (crosses_itself) return elsewhere && !is_inside(search.crossed_here, slot_of(traits));
    if (!closed_shell) return elsewhere && !(leaving && (traits & kSingleSided) != 0u);
    return is_inside(search.media, slot_of(traits)) == (leaving != ((traits & kCavity) != 0u));
}

// Whether what fills the place is drawn by a volume.
bool in_replaced(uint body) { return kVolumes && body != kAir && (slots[body].material & kReplacedSolid) != 0u; }

#ifdef PELLUCID_RAY_QUERY
#include "layers/trace_surface.glsl"
#else
#include "layers/object_walk.glsl"
#include "layers/candidates.glsl"
#endif

void begin_search(Media media, uint standing, uint pixel, out Search search) {
    copy_media(media, search.media);
    search.standing = standing;
    search.pixel = pixel;
    search.wanted = kFindAll;
    search.replaced = kMeetNone;
    clear_media(search.crossed_here);
    search.deciding = false;
    clear_media(search.decided);
    search.decided_shell = kNoSlot;
    search.limit = kFarthest;
    search.visits = 0u;
    search.most_visits = kMostVisits;
    search.gave_up = false;
    search.object_traits = search.first_triangle = 0u;
}

const float kApart = 16.0;  // coincidences along a ray, which may graze

// The nearest surface beyond `t_min`, m; `t_end`: where what is known of the scene ends on the way.
SurfaceHit find_next(vec3 origin, vec3 direction, float t_min, inout Search search, out float t_end) {
    t_end = kFarthest;
#ifdef PELLUCID_RAY_QUERY
    return trace_surface(origin, direction, t_min, kApart * coincidence, search);
#else
    if (kFoundOnHost) return find_candidate(origin, direction, t_min, search);
    if (kMapPerMesh) return find_surface_among_objects(origin, direction, t_min, search);
    return find_surface(maps[0], origin, direction, t_min, search, t_end);
#endif
}

// Counts all surfaces of a shell that crosses itself which are on a ray: what it winds around the start.
void find_winding(uint shell, vec3 origin, vec3 direction, Search search, inout Media media) {
    search.decided_shell = shell;
    search.visits = 0u;
    int winding = 0;
    float t = 0.0, t_end;
    for (bool more = true; more;) {
        SurfaceHit hit = find_next(origin, direction, t, search, t_end);
        more = hit.t < kFarthest && hit.t > t;
        if (more) winding += hit.leaving ? 1 : -1;
        t = hit.t;
    }
    for (; winding > 0; --winding) step_across(media, kCrossesItself | shell << kSlotShift, false);
    for (; winding < 0; ++winding) step_across(media, kCrossesItself | shell << kSlotShift, true);
}

// What a ray is inside of where it starts: of each slot, the first surface on its way says it.
void find_media(vec3 origin, vec3 direction, out Media media) {
    clear_media(media);
    Search search;
    begin_search(media, PELLUCID_NO_TRIANGLE, 0u, search);
    search.deciding = true;
    for (uint n = 0u; n < 32u * kMediumWords; ++n) {
        float t_end;
        SurfaceHit hit = find_next(origin, direction, 0.0, search, t_end);
        if (hit.t == kFarthest) break;
        uint slot = slot_of(hit.traits);
        set_inside(search.decided, slot, true);
        set_inside(media, slot, hit.leaving != ((hit.traits & kCavity) != 0u));
    }
    if (kCrossing) {
        for (uint slot = 0u; slot < slots.length(); ++slot) {
            bool more = (slots[slot].medium & kSameShell) != 0u;
            if (more) find_winding(slot, origin, direction, search, media);
            while (more) more = (slots[++slot].medium & kSameShell) != 0u;
        }
    }
}

#endif
