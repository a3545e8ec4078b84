#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_FOLLOW_PATHS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_FOLLOW_PATHS_GLSL

// Advances every path by one or a few surfaces, across glass. A path ends at an opaque surface, or if it hits nothing.
// Programs that define PELLUCID_HELD_VOLUMES support solids that contain volumes.
#include "techniques/visibility_layers/visibility_bindings.glsl"
#include "gpu/vertices.glsl"
#include "techniques/visibility_layers/path_walk.glsl"
#include "techniques/visibility_layers/cross_boundary.glsl"

// Twin of ObjectBox in scene_topology.cpp.
struct ObjectBox {
    vec3 low;
    float radius;  // m, from the box's centre to the farthest vertex
    vec3 high;
    float contact;  // m, see contact_distance()
};
layout(std430, set = 0, binding = 27) readonly buffer Boxes { ObjectBox boxes[]; };  // per object, in world space
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)
PELLUCID_APPENDED_LIST(EndedList, 25, ended_groups, ended_length, ended_pixels, append_ended)

#include "volume/volume_record.glsl"
layout(std430, set = 0, binding = 30) readonly buffer Volumes { VolumeRecord volumes[]; };
// Paths that enter volumes, or that another map must finish; never both in one program.
PELLUCID_APPENDED_LIST(SetAside, 31, aside_groups, aside_length, aside_pixels, append_set_aside)
#include "volume/volume_boxes.glsl"

#ifdef PELLUCID_HELD_VOLUMES
layout(set = 0, binding = 5) uniform texture3D volume_index;
layout(set = 0, binding = 38) uniform texture3D volume_bricks;
#include "volume/volume_field.glsl"

// Indices of refraction of a body at a position on its surface.
vec3 iors_at(uint body, vec3 place) {
    if (proxy != kSharpInterfaces || !in_replaced(body)) return filling_iors(body);
    for (uint i = 0u; i < volume_count; ++i) {
        vec3 x = voxel_position(volumes[i], place);
        bool outside = any(lessThan(x, vec3(-kLeastCrossing))) || any(greaterThan(x, volumes[i].size + kLeastCrossing));
        if ((volumes[i].flags & kMeshVolume) == 0u || outside) continue;
        vec3 iors;
        for (uint c = 0u; c < 3u; ++c) {
            enter_volume(volumes[i], (volumes[i].flags & kDispersiveVolume) != 0u ? c + 1u : 0u);
            iors[c] = index_field(x).w;
        }
        return iors;
    }
    return filling_iors(body);
}
#else
vec3 iors_at(uint body, vec3 place) { return filling_iors(body); }
#endif

layout(constant_id = 10) const uint kSurfacesPerPass = 1u;
layout(constant_id = 7) const bool kOpaqueObjects = false;  // the scene has opaque objects
layout(constant_id = 28) const bool kFinished = false;      // another map finishes paths that this map loses

// Passes a pane, which bends no light. Its two faces and the reflections between them are one factor.
void pass_pane(inout Path path, Surface surface) {
    float once = fresnel_dielectric(abs(dot(path.direction, surface.normal)), 1.0 / materials[surface.material].ior);
    vec4 tint = surface_tint(surface);
    path.transmittance *= mix(vec3(1.0), (1.0 - 2.0 * once / (1.0 + once)) * tint.rgb, tint.a);
}

// Transmits or reflects a photon at a pane, at random.
void pass_pane_as_photon(inout PathState state, Surface surface) {
    float cosine = abs(dot(state.path.direction, surface.normal));
    float once = fresnel_dielectric(cosine, 1.0 / materials[surface.material].ior);
    vec4 tint = surface_tint(surface);
    float reflected = tint.a * 2.0 * once / (1.0 + once);
    if (random_number(state.seed ^ (surface.corner + 1u) * 0x51ed270bu, state.path.events) < reflected) {
        state.path.direction = reflect_direction(state.path.direction, faceforward(surface.normal, state.path.direction, surface.normal));
        ++state.path.events;
        state.mark &= ~kUnbent;
        choose_spacing(state.path, reflected);
    } else {
        state.path.transmittance *= mix(vec3(1.0), (1.0 - 2.0 * once / (1.0 + once)) * tint.rgb, tint.a) / (1.0 - reflected);
        choose_spacing(state.path, 1.0 - reflected);
    }
}

// True if the ray hits an object's box, and the ball around it, beyond the edge of the view's map.
bool meets_boxes(vec3 position, vec3 direction) {
    bool any_met = false;
    for (uint i = 0u; i < frame.object_count; ++i) {
        ObjectBox object = boxes[i];
        vec3 from = position - 0.5 * (object.low + object.high);
        float along = dot(from, direction), radius = object.radius + coincidence;
        float half_chord = sqrt(max(radius * radius - dot(from, from) + along * along, 0.0));
        float near = max(-along - half_chord, 0.0), far = -along + half_chord;
        for (int k = 0; k < 3; ++k) {
            clip(position[k] - object.low[k] + coincidence, direction[k], near, far);
            clip(object.high[k] + coincidence - position[k], -direction[k], near, far);
        }
        any_met = any_met || near <= far;
    }
    return any_met;
}

// Distance, m, below which surfaces of two objects count as touching.
float contact_distance(uint object_a, uint object_b, vec3 place) {
    float spacings = max(max(abs(place.x), abs(place.y)), abs(place.z)) * 4.8e-7;  // four float spacings
    return max(max(boxes[object_a].contact, boxes[object_b].contact), spacings);
}

// A surface hit by a path.
struct MetSurface {
    SurfaceHit hit;
    uint object;
    Surface surface;
};

MetSurface met_surface(SurfaceHit hit, vec3 origin, vec3 direction) {
    uint object = object_of(hit.triangle);
    return MetSurface(hit, object, surface_at(hit.triangle, object, origin, direction));
}

// Finds a surface of the wanted kind that touches another.
bool find_touching(MetSurface other, vec3 direction, Search search, out MetSurface touching) {
    const float kGrazing = 512.0;  // rays with a smaller slope than 1 in 512 do not detect contact
    const float kBehind = 32.0;    // rounding of positions along a flat ray, in contact distances
    vec3 place = other.surface.position;
    float t_end, apart = contact_distance(other.object, other.object, place);
    for (int k = 0; k < 2; ++k) {  // the other object may have the larger contact distance
        search.visits = 0u;
        search.limit = kGrazing * apart;
        touching.hit = find_next(place, direction, -kBehind * apart, search, t_end);
        if (k == 1 || touching.hit.t < kFarthest) break;
        apart = max(apart, largest_contact);
    }
    if (touching.hit.t == kFarthest) return false;
    touching = met_surface(touching.hit, place, direction);
    vec3 normal = touching.surface.geometric;
    float across = abs(dot(direction, normal)) / max(length(normal), 1e-30);
    return abs(touching.hit.t) * across <= contact_distance(other.object, touching.object, place);
}

// True if `body` has the boundary: of two bodies whose media meet, the displacing body has it.
bool has_boundary(uint body, uint other, uint before, uint beyond) {
    bool meets = body == before || body == beyond, other_meets = other == before || other == beyond;
    return meets && (!other_meets || body > other);
}

// True if a path starts at an opaque surface, which neighbouring triangles continue.
bool leaves_opaque(PathState state) {
    return has_mark(state, kToLight | kBounced) && state.standing != PELLUCID_NO_TRIANGLE &&
           (traits[object_of(state.standing)] & kKindMask) == kOpaqueKind;
}

// Finds the next surface on a path.
SurfaceHit find_ahead(PathState state, bool in_body, inout Search search, out float t_end) {
    SurfaceHit hit;
    float t_min = -coincidence;
    for (int attempt = 0; attempt < 2; ++attempt) {
        hit = find_next(state.path.position, state.path.direction, t_min, search, t_end);
        // Skip opaque surfaces behind a path that was reflected where its solid touches them. Also skip neighbouring
        // triangles of a shell that crosses itself: they continue the path's surface.
        bool opaque = (hit.traits & kKindMask) == kOpaqueKind;
        bool behind = opaque && (in_body || leaves_opaque(state));
        bool crossed = kCrossing && (hit.traits & kCrossesItself) != 0u && state.standing != PELLUCID_NO_TRIANGLE;
        if (hit.t > coincidence || !(behind || crossed)) break;
        t_min = coincidence;
    }
    return hit;
}

// Moves a path to the first volume before a surface at `t`, and returns true if there is one. The volume lies outside
// all solids, or in the path's solid. A path at a surface crosses the surface first.
bool enters_volume(inout PathState state, uint body, float t) {
    if (!(body == kAir || in_replaced(body)) || t <= kApart * coincidence) return false;
    float straight;
    uint of_kind = volumes_of(in_replaced(body), proxy);
    uint volume = next_volume(state.path.position, state.path.direction, of_kind, straight);
    if (volume == kNoVolume || straight >= t) return false;
    state.path.position += straight * state.path.direction;
    return true;
}

// Status of a path that hits nothing.
uint status_of_end(Path path, bool in_body, bool gave_up, float t_end) {
    if (gave_up) return kStatusStepLimit;
    if (!kMapPerMesh && t_end < kFarthest && meets_boxes(path.position + t_end * path.direction, path.direction))
        return kStatusLeftScreen;
    return in_body ? kStatusMissingLayer : path.status;
}

// An object that supports a solid lies outside of it: a path in the solid that hits the object leaves the solid first.
void take_wall_first(vec3 direction, Search search, inout MetSurface met) {
    MetSurface wall;
    search.wanted = kFindShells;
    if (find_touching(met, direction, search, wall) && wall.hit.leaving) met = wall;
}

// Crosses all boundaries that touch at one position, since their order is arbitrary. `met` becomes the boundary
// between the media of both sides, or the opaque surface that stops the path.
void cross_touching(vec3 direction, Search search, Media here, inout MetSurface met, inout Media media) {
    const int kMostTouching = 16;
    uint before = filling_body(here);
    MetSurface other, at = met;
    bool leaves = met.hit.leaving;
    search.wanted = kFindShells;
    for (int n = 0; n < kMostTouching; ++n) {
        copy_media(media, search.media);
        if (!find_touching(at, direction, search, other)) break;
        step_across(media, other.hit.traits, other.hit.leaving);
        note_crossed(search, other.hit.traits);
        leaves = leaves || other.hit.leaving;
        if (has_boundary(body_of(other.hit.traits), body_of(met.hit.traits), before, filling_body(media))) met = other;
    }
    search.wanted = kFindOpaque;
    if (kOpaqueObjects && !leaves && find_touching(at, direction, search, other)) {
        met = other;  // an opaque object supports the solid
        copy_media(here, media);
    }
}

// Moves a path across a surface of glass, which may be no boundary of media.
void pass_glass(inout PathState state, MetSurface met, Media here, uint before, uint beyond) {
    state.mark &= ~(kUnbent | kFromGlass);
    Crossing crossing;
    crossing.surface = met.surface;
    crossing.leaving = met.hit.leaving;
    crossing.first = whole_picture == 0u && state.path.events == 0u && has_mark(state, kMainPath) && before == kAir;
    copy_media(here, crossing.here);
    copy_media(state.media, crossing.there);
    crossing.n_i = iors_at(before, met.surface.position);
    crossing.n_t = iors_at(beyond, met.surface.position);
    cross_boundary(state, crossing);
}

// Passes a shadow ray straight through glass, or blocks it.
void pass_shadow(inout PathState state, MetSurface met, uint before, uint beyond) {
    vec3 normal = met.hit.leaving ? -met.surface.normal : met.surface.normal;
    float n_i = filling_iors(before).g, n_t = filling_iors(beyond).g;
    bool blocks = tinted_shadows == 0u || has_mark(state, kFromGlass);
    float passes = blocks ? 0.0 : 1.0 - fresnel_dielectric(-dot(state.path.direction, normal), n_i / n_t);
    state.path.transmittance *= met.hit.leaving ? vec3(passes) : passes * surface_tint(met.surface).rgb;
    ++state.path.events;
}

// Ends the path at a lamp with a size before a surface at `t`, and returns true if there is one.
bool meets_lamp(inout PathState state, uint body, float t) {
    if (kVisibleLights == 0u || has_mark(state, kToLight | kBounced) || spread_of(state.mark) > 0.0) return false;
    if (kPhotons && has_mark(state, kFromDiffuse)) return false;
    vec3 radiance;
    float straight = lamp_ahead(state.path.position, state.path.direction, t, radiance);
    if (straight >= t) return false;
    if (body == kAir) state.path.position += straight * state.path.direction;
    else travel(state.path, straight, filling_material(body).sigma_a.rgb);
    state.path.transmittance *= has_mark(state, kFromGlass) ? vec3(0.0) : radiance;
    state.mark |= kMetLamp;
    return true;
}

// Advances a path to the next surface and across it. Returns false if the path ends or enters a volume.
bool go_on(inout PathState state) {
    uint body = filling_body(state.media);
    if (in_replaced(body) && proxy != kSharpInterfaces) {
        state.mark |= kEntersVolume;
        return false;
    }
    Search search;
    begin_search(state.media, state.standing, state.pixel, search);
    if (kVolumes && proxy != 0u) search.replaced = kMeetEntering;
    bool to_light = kLightsSurfaces && has_mark(state, kToLight);
    float t_end, left = state.path.length_inside;
    if (to_light) search.limit = left;
    SurfaceHit hit = find_ahead(state, body != kAir, search, t_end);
    if (to_light && t_end >= left) t_end = kFarthest;
    if (kVolumes && enters_volume(state, body, hit.t)) {
        state.mark |= kEntersVolume;
        return false;
    }
    if (meets_lamp(state, body, hit.t)) return false;
    if (hit.t == kFarthest) {
        uint status = status_of_end(state.path, body != kAir, search.gave_up, t_end);
        if (kFinished && (status == kStatusLeftScreen || status == kStatusStepLimit)) state.mark |= kLost;
        else state.path.status = status;
        return false;
    }
    MetSurface met = met_surface(hit, state.path.position, state.path.direction);
    float straight = distance(state.path.position, met.surface.position);
    bool may_touch = kTouching && (hit.traits & kTouchesOthers) != 0u;
    if (kTouching && may_touch && !refractive(hit.traits) && body != kAir)
        take_wall_first(state.path.direction, search, met);
    uint before = body, beyond = body;
    Media here;
    copy_media(state.media, here);
    if (refractive(met.hit.traits)) {
        correct_side(state.media, met.hit.traits, met.hit.leaving);
        copy_media(state.media, here);
        step_across(state.media, met.hit.traits, met.hit.leaving);
        note_crossed(search, met.hit.traits);
        if (kTouching && may_touch) cross_touching(state.path.direction, search, here, met, state.media);
        before = filling_body(here);
        beyond = filling_body(state.media);
    }
    bool meets = refractive(met.hit.traits) && is_interface(before, beyond);
    if (meets && state.path.events >= max_events) {
        state.path.status = kStatusEventLimit;
        return false;
    }
    if (kFromLight && !has_mark(state, kUnbent)) widen_spacing(state.path, straight);
    if (kFromLight && body != kAir) state.path.transmittance *= beer_lambert(filling_material(body).sigma_a.rgb, straight);
    else if (body != kAir) travel(state.path, straight, filling_material(body).sigma_a.rgb);
    state.path.position = met.surface.position;
    state.standing = met.hit.triangle;
    bool ends = (met.hit.traits & kKindMask) == kOpaqueKind;
    if (to_light) state.path.length_inside = left - straight;
    if (ends) state.mark |= kMetOpaque;
    else if (meets && to_light) pass_shadow(state, met, before, beyond);
    else if (meets) pass_glass(state, met, here, before, beyond);
    else if (!refractive(met.hit.traits) && kFromLight) pass_pane_as_photon(state, met.surface);
    else if (!refractive(met.hit.traits)) pass_pane(state.path, met.surface);
    return !ends && !(to_light && state.path.transmittance == vec3(0.0));
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    uint i = uint(texel.y) * frame.width + uint(texel.x);
    PathState state;
    load_path(i, sample_seed(texel), state);
    state.mark &= ~kLost;
    bool goes_on = true;
    for (uint k = 0u; k < kSurfacesPerPass && goes_on; ++k) goes_on = go_on(state);
    save_path(state);
    if (goes_on) append_next(texel);
    else if (kVolumes && has_mark(state, kEntersVolume)) append_set_aside(texel);
    else if (kFinished && has_mark(state, kLost)) append_set_aside(texel);
    else append_ended(texel);
}

#endif
