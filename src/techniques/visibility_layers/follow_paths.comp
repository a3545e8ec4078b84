#version 460
// Takes every path on to the next surface, or the next few, and past them if they are glass; where there is none, or an
// opaque one, the path ends.
#extension GL_GOOGLE_include_directive : require
#include "techniques/visibility_layers/visibility_bindings.glsl"
#include "techniques/visibility_layers/path_walk.glsl"

// Twin of ObjectBox in scene_topology.cpp.
struct ObjectBox {
    vec3 low;
    float radius;  // from the middle of the box to the farthest vertex
    vec3 high;
    float reserved;
};
layout(std430, set = 0, binding = 27) readonly buffer Boxes { ObjectBox boxes[]; };  // per object, world
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)
PELLUCID_APPENDED_LIST(EndedList, 25, ended_groups, ended_length, ended_pixels, append_ended)

#include "volume/volume_record.glsl"
layout(std430, set = 0, binding = 30) readonly buffer Volumes { VolumeRecord volumes[]; };
PELLUCID_APPENDED_LIST(EnteringList, 31, entering_groups, entering_length, entering_pixels, append_entering)
#include "volume/volume_boxes.glsl"

layout(constant_id = 10) const uint kSurfacesPerPass = 1u;

// A pane that bends no light: its two faces and the reflections between them are one factor.
void pass_pane(inout Path path, Surface surface) {
    MaterialRecord material = materials[surface.material];
    float once = fresnel_dielectric(abs(dot(path.direction, surface.normal)), 1.0 / material.ior);
    path.transmittance *= (1.0 - 2.0 * once / (1.0 + once)) * material.base_color.rgb * material.transmission;
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

int boundary_rank(SurfaceHit hit, uint before, uint beyond) {
    uint rank = rank_of(hit.traits);
    return rank == before || rank == beyond ? int(rank) : -1;
}

// Takes the path to the next surface, and past it. False: it ends there, or nowhere.
bool go_on(uint i, inout Path path) {
    uint rank = filling_rank();
    if (in_replaced(rank)) {
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
        hit = kMapPerMesh ? find_surface_among_objects(path.position, path.direction, t_min, kApart * coincidence, gave_up, visits)
                          : find_surface(maps[0], path.position, path.direction, t_min, t_end, gave_up, visits);
        // Reflected where its solid touches something opaque, which the path then has behind it.
        if (rank == kAir || hit.t > coincidence || (hit.traits & kKindMask) != kOpaqueKind) break;
        t_min = coincidence;
    }
    // A path in the open enters the volume that it meets first. One that stands at a surface crosses that before.
    if (kVolumes && rank == kAir && hit.t > kApart * coincidence) {
        float straight;
        if (next_volume(path.position, path.direction, straight) != kNoVolume && straight < hit.t) {
            path.position += straight * path.direction;
            mark |= kEntersVolume;
            return false;
        }
    }
    bool found = hit.t < kFarthest;
    if (!found) {
        if (gave_up) path.status = kStatusStepLimit;
        else if (!kMapPerMesh && t_end < kFarthest && meets_boxes(path.position + t_end * path.direction, path.direction))
            path.status = kStatusLeftScreen;
        else if (rank != kAir) path.status = kStatusMissingLayer;
    }
    bool glass = refractive(hit.traits);
    if (found && glass && path.events >= max_events) {
        path.status = kStatusEventLimit;
        found = false;
    }
    if (!found) return false;
    // Where boundaries of two objects lie at one place, the order in which they are found is chance: both are crossed
    // at once. What a solid stands on is outside of it.
    bool touching = false;
    if (kTouching && second_hit.t - hit.t <= kApart * coincidence) {
        bool second_is_glass = refractive(second_hit.traits);
        touching = glass && second_is_glass;
        if (glass != second_is_glass && (glass ? !hit.leaving : second_hit.leaving)) {
            hit = second_hit;
            glass = second_is_glass;
        }
    }
    uint before = rank, beyond = rank;
    if (glass) {
        correct_side(hit.traits, hit.leaving);
        if (touching) correct_side(second_hit.traits, second_hit.leaving);
        before = filling_rank();
        note_here();
        step_across(hit.traits, hit.leaving);
        if (touching) step_across(second_hit.traits, second_hit.leaving);
        note_there();
        beyond = filling_rank();
        // Of the solids whose media meet here, the one that displaces the other has the boundary.
        if (touching && boundary_rank(second_hit, before, beyond) > boundary_rank(hit, before, beyond)) hit = second_hit;
    }
    Surface surface = surface_at(hit.triangle, object_of(hit.triangle), path.position, path.direction);
    if (before != kAir) travel(path, distance(path.position, surface.position), filling_material(before).sigma_a.rgb);
    path.position = surface.position;
    standing = hit.triangle;
    bool ends = (hit.traits & kKindMask) == kOpaqueKind;
    if (ends) mark |= kMetOpaque;
    else if (!glass) pass_pane(path, surface);
    else if (beyond != before) meet_boundary(i, path, surface, hit.leaving, filling_iors(before), filling_iors(beyond), false);
    return !ends;
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    uint i = uint(texel.y) * frame.width + uint(texel.x);
    seed = hash(uvec3(texel, 1u)).x;
    Path path = load_path(i);
    bool goes_on = true;
    for (uint k = 0u; k < kSurfacesPerPass && goes_on; ++k) goes_on = go_on(i, path);
    save_path(i, path);
    if (goes_on) append_next(texel);
    else if (kVolumes && (mark & kEntersVolume) != 0u) append_entering(texel);
    else append_ended(texel);
}
