#version 460
// Rays outside the object search one layer for an entry: again into the object that they have left (3.5), or from
// object to object (3.7).
#extension GL_GOOGLE_include_directive : require
#include "techniques/wang_2014/ray_state.glsl"
#include "techniques/wang_2014/search.glsl"

#include "techniques/wang_2014/first_surface.glsl"

layout(constant_id = 0) const bool kNextObject = false;  // search layer 1 of an object, not a deeper entry

PELLUCID_APPENDED_LIST(Inside, 17, inside_groups, inside_length, inside_pixels, append_inside)

// Searches the layer along a ray outside the object, first in linear, then in binary steps (3.3, 3.5). Entries are hit
// from the front: a ray that appears from behind leaves a fault zone.
Hit search_entry(vec3 world_origin, vec3 world_direction, bool on_layer, bool from_afar) {
    Walk walk = begin_walk(world_origin, world_direction, on_layer, from_afar);
    // Beyond the farthest entry of the image there is nothing to hit.
    float deepest = uintBitsToFloat(farthest_entry) + fault_size;
    walk.end = min(walk.end, reach_zero(deepest - walk.ray.depth, -walk.ray.depth_rate));
    bool behind = is_behind(walk.ray, walk.after);
    while (pass_layer(walk, behind)) {
        float jump;
        float hit = binary_search(walk, layer, false, jump);
        if (jump <= fault_size) return Hit(hit, layer, kStatusOk);
    }
    return no_hit(walk);
}

// Continues a ray that has left a solid to this object. Returns true if it is now inside.
bool meet_surface_ahead(inout Path path) {
    if (path.status != kStatusOk) return false;  // the path was lost before
    // A ray that has left this object starts on the searched layer.
    Hit hit = search_entry(path.position, path.direction, !kNextObject, kNextObject);
    if (hit.distance < 0.0) {
        // Most paths hit no further glass. Over glass at the image border the result is unknown.
        if (hit.status == kStatusLeftScreen) path.status = hit.status;
        return false;
    }
    path.position += hit.distance * path.direction;
    return cross_interface(path, normal_at(world_pixel(path.position), hit.layer), false, object_material().ior);
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;

    Path path;
    bool meets;
    if (kNextObject && imageLoad(path_events, ivec3(texel, 0)).r == 0u) {
        if (!sees_object(texel)) return;
        path = pass_first_surface(texel);  // case 1 of 3.7
        meets = path.status == kStatusOk;
    } else {
        path = load_path(texel);
        uint status = path.status, events = path.events;
        float before = path.length_inside;
        meets = meet_surface_ahead(path);  // case 3
        note_steps(path, before);
        if (path.events == events && path.status == status && !kCountsSteps) return;  // case 2
    }
    store_world_refraction(texel, path);
    if (meets) append_inside(texel);
}
