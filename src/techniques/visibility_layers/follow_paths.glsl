#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_FOLLOW_PATHS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_FOLLOW_PATHS_GLSL

// Takes every path on to the next surface, or the next few, and past them if they are glass; where there is none, or an
// opaque one, the path ends. Programs that define PELLUCID_HELD_VOLUMES know of solids that hold volumes.
#include "techniques/visibility_layers/visibility_bindings.glsl"
#include "techniques/visibility_layers/path_walk.glsl"

// Twin of ObjectBox in scene_topology.cpp.
struct ObjectBox {
    vec3 low;
    float radius;  // from the middle of the box to the farthest vertex
    vec3 high;
    float contact;  // m, see contact_distance()
};
layout(std430, set = 0, binding = 27) readonly buffer Boxes { ObjectBox boxes[]; };  // per object, world
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)
PELLUCID_APPENDED_LIST(EndedList, 25, ended_groups, ended_length, ended_pixels, append_ended)

#include "volume/volume_record.glsl"
layout(std430, set = 0, binding = 30) readonly buffer Volumes { VolumeRecord volumes[]; };
PELLUCID_APPENDED_LIST(EnteringList, 31, entering_groups, entering_length, entering_pixels, append_entering)
#include "volume/volume_boxes.glsl"

#ifdef PELLUCID_HELD_VOLUMES
layout(set = 0, binding = 5) uniform texture3D volume_index;
layout(set = 0, binding = 38) uniform texture3D volume_bricks;
#include "volume/volume_field.glsl"

// Indices of refraction of a body, at a place on its surface.
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
layout(constant_id = 7) const bool kOpaqueObjects = false;  // there are some

// A pane that bends no light: its two faces and the reflections between them are one factor.
void pass_pane(inout Path path, Surface surface) {
    float once = fresnel_dielectric(abs(dot(path.direction, surface.normal)), 1.0 / materials[surface.material].ior);
    vec4 tint = surface_tint(surface);
    path.transmittance *= mix(vec3(1.0), (1.0 - 2.0 * once / (1.0 + once)) * tint.rgb, tint.a);
}

// Whether the way goes on through an object's box, and the ball around it, beyond the edge of the view's map.
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

// Surfaces of two objects no farther apart are at the same place; m.
float contact_distance(uint object_a, uint object_b, vec3 place) {
    float spacings = max(max(abs(place.x), abs(place.y)), abs(place.z)) * 4.8e-7;  // four spacings of a float
    return max(max(boxes[object_a].contact, boxes[object_b].contact), spacings);
}

// A surface at the same place as one that the path stands on; of the kind that is looked for.
bool find_touching(uint object, vec3 place, vec3 direction, out SurfaceHit touching, out Surface surface) {
    const float kGrazing = 512.0;  // along a ray that lies flatter than one in so many, surfaces are not seen to touch
    const float kBehind = 32.0;    // rounding puts places on a flat ray as far off
    float t_end, apart = contact_distance(object, object, place);
    for (int k = 0; k < 2; ++k) {  // the other may be the larger one
        bool gave_up;
        uint visits = 0u;
        walk_limit = kGrazing * apart;
        touching = find_next(place, direction, -kBehind * apart, t_end, gave_up, visits);
        walk_limit = kFarthest;
        if (k == 0 && touching.t == kFarthest) {
            apart = max(apart, largest_contact);
        } else {
            break;
        }
    }
    if (touching.t == kFarthest) return false;
    uint other = object_of(touching.triangle);
    surface = surface_at(touching.triangle, other, place, direction);
    float across = abs(dot(direction, surface.geometric)) / max(length(surface.geometric), 1e-30);
    return abs(touching.t) * across <= contact_distance(object, other, place);
}

// Of the bodies whose media meet, the one that displaces the other has the boundary.
bool has_boundary(uint body, uint other, uint before, uint beyond) {
    bool meets = body == before || body == beyond, other_meets = other == before || other == beyond;
    return meets && (!other_meets || body > other);
}

// Takes the path to the next surface, and past it. False: it ends there, or nowhere.
bool go_on(uint i, inout Path path) {
    uint body = filling_body();
    if (in_replaced(body) && proxy != kSharpInterfaces) {
        mark |= kEntersVolume;
        return false;
    }
    meets_replaced = kVolumes && proxy != 0u ? kMeetEntering : kMeetNone;
    SurfaceHit hit;
    bool gave_up;
    float t_end;
    uint visits = 0u;
    float t_min = -coincidence;
    for (int attempt = 0; attempt < 2; ++attempt) {
        hit = find_next(path.position, path.direction, t_min, t_end, gave_up, visits);
        // Reflected where its solid touches something opaque, which the path then has behind it. And of a shell that
        // crosses itself, neighbours of the triangle that the path stands on are that surface still.
        bool behind = body != kAir && (hit.traits & kKindMask) == kOpaqueKind;
        bool crossed = kCrossing && (hit.traits & kCrossesItself) != 0u && standing != PELLUCID_NO_TRIANGLE;
        if (hit.t > coincidence || !(behind || crossed)) break;
        t_min = coincidence;
    }
    // A path enters the volume that it meets first, in the open or of the solid that it is in. One that stands at a surface
    // crosses that before.
    if (kVolumes && (body == kAir || in_replaced(body)) && hit.t > kApart * coincidence) {
        float straight;
        uint volume = next_volume(path.position, path.direction, volumes_of(in_replaced(body), proxy), straight);
        if (volume != kNoVolume && straight < hit.t) {
            path.position += straight * path.direction;
            mark |= kEntersVolume;
            return false;
        }
    }
    if (hit.t == kFarthest) {
        if (gave_up) path.status = kStatusStepLimit;
        else if (!kMapPerMesh && t_end < kFarthest && meets_boxes(path.position + t_end * path.direction, path.direction))
            path.status = kStatusLeftScreen;
        else if (body != kAir) path.status = kStatusMissingLayer;
        return false;
    }
    bool glass = refractive(hit.traits);
    uint object = object_of(hit.triangle);
    Surface surface = surface_at(hit.triangle, object, path.position, path.direction);
    float straight = distance(path.position, surface.position);
    bool may_touch = kTouching && (hit.traits & kTouchesOthers) != 0u;
    if (kTouching && may_touch && !glass && body != kAir) {
        // What a solid stands on is outside of it: the path leaves the solid first.
        SurfaceHit wall;
        Surface wall_surface;
        looks_for = kFindShells;
        if (find_touching(object, surface.position, path.direction, wall, wall_surface) && wall.leaving) {
            hit = wall;
            surface = wall_surface;
            object = object_of(hit.triangle);
            glass = true;
        }
        looks_for = kFindAll;
    }
    uint before = body, beyond = body;
    if (glass) {
        correct_side(hit.traits, hit.leaving);
        before = filling_body();
        note_here();
        step_across(hit.traits, hit.leaving);
        note_crossed(hit.traits);
        // Where boundaries lie at one place, the order in which they are found is chance: all are crossed at once.
        if (kTouching && may_touch) {
            const int kMostTouching = 16;
            uint at_object = object;
            vec3 place = surface.position;
            bool leaves = hit.leaving;
            looks_for = kFindShells;
            beyond = filling_body();
            for (int n = 0; n < kMostTouching; ++n) {
                SurfaceHit other;
                Surface other_surface;
                if (!find_touching(at_object, place, path.direction, other, other_surface)) break;
                step_across(other.traits, other.leaving);
                note_crossed(other.traits);
                beyond = filling_body();
                leaves = leaves || other.leaving;
                if (has_boundary(body_of(other.traits), body_of(hit.traits), before, beyond)) {
                    hit = other;
                    surface = other_surface;
                }
            }
            looks_for = kFindOpaque;
            SurfaceHit wall;
            Surface wall_surface;
            if (kOpaqueObjects && !leaves && find_touching(at_object, place, path.direction, wall, wall_surface)) {
                hit = wall;  // it stands on that
                surface = wall_surface;
                glass = false;
                for (uint w = 0u; w < kMediumWords; ++w) media[w] = media_here[w];
            }
            looks_for = kFindAll;
        }
        forget_crossed();
        note_there();
        beyond = filling_body();
    }
    bool meets = glass && is_interface(before, beyond);
    if (meets && path.events >= max_events) {
        path.status = kStatusEventLimit;
        return false;
    }
    if (body != kAir) travel(path, straight, filling_material(body).sigma_a.rgb);
    path.position = surface.position;
    standing = hit.triangle;
    bool ends = (hit.traits & kKindMask) == kOpaqueKind;
    if (ends) mark |= kMetOpaque;
    else if (!glass) pass_pane(path, surface);
    else if (meets) {
        bool first = whole_picture == 0u && path.events == 0u && (mark & kMainPath) != 0u && before == kAir;
        meet_boundary(i, path, surface, hit.leaving, iors_at(before, surface.position), iors_at(beyond, surface.position), first);
    }
    return !ends;
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    uint i = uint(texel.y) * frame.width + uint(texel.x);
    seed = hash(uvec3(texel, 1u)).x;
    path_number = i;
    Path path = load_path(i);
    bool goes_on = true;
    forget_crossed();
    for (uint k = 0u; k < kSurfacesPerPass && goes_on; ++k) goes_on = go_on(i, path);
    save_path(i, path);
    if (goes_on) append_next(texel);
    else if (kVolumes && (mark & kEntersVolume) != 0u) append_entering(texel);
    else append_ended(texel);
}

#endif
