#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_WALK_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_WALK_GLSL

// Search for the surfaces that paths hit, and the conditions for a hit. Programs that define PELLUCID_RAY_QUERY use
// the device's ray tracing instead of maps. Needs: visibility_bindings.glsl.
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

// Hits on surfaces that a volume replaces (kReplaced).
const uint kMeetNone = 0u, kMeetEntering = 1u, kMeetAll = 2u;
// Kinds of surfaces searched: all; closed shells of glass only; opaque surfaces only.
const uint kFindAll = 0u, kFindShells = 1u, kFindOpaque = 2u;

// A search for a path's next surface.
struct Search {
    Media media;    // solids around the path
    uint standing;  // triangle on which the path stands
    uint pixel;     // index of the path's pixel
    uint wanted;    // kFindAll, ...
    uint replaced;  // kMeetNone, ...
    // self-crossing shells crossed at this position, by first slot; their other surfaces here are not hit again
    Media crossed_here;
    bool deciding;                       // true: the search determines the media around the start
    Media decided;                       // slots whose state is known
    uint decided_shell;                  // restricts the search to all surfaces of this self-crossing shell
    float limit;                         // m, longest distance
    uint visits, most_visits;            // nodes and records visited
    bool gave_up;                        // true if there were too many
    uint object_traits, first_triangle;  // of the object whose maps are searched; its records omit them
};

void note_crossed(inout Search search, uint traits) {
    if (kCrossing && (traits & kCrossesItself) != 0u) set_inside(search.crossed_here, slot_of(traits), true);
}

// Rays enter and leave a shell alternately, so the path's own surface is never hit again.
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

// True if a volume draws the body.
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

const float kApart = 16.0;  // tolerance along a ray, in coincidence distances; the ray may graze

// Finds the nearest surface beyond `t_min`, m. `t_end`: distance at which the known part of the scene ends.
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

// Finds the winding number of a self-crossing shell around the start, by counting all its surfaces along a ray.
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

// Finds the solids around the start of a ray: the first surface of each slot along the ray determines its state.
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
