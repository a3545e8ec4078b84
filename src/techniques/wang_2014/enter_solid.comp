#version 460
// Rays outside the object look for a way in through one layer: again into the object that they have left (3.5), or
// from object to object (3.7).
#extension GL_GOOGLE_include_directive : require
#include "techniques/wang_2014/ray_state.glsl"
#include "techniques/wang_2014/search.glsl"

#include "techniques/wang_2014/first_surface.glsl"

layout(constant_id = 0) const bool kNextObject = false;  // layer 1 of an object is searched, not a deeper entry

layout(std430, set = 0, binding = 17) buffer Inside {
    uint inside_groups[3];
    uint inside_length;
    uint inside_pixels[];
};

// A ray that has left a solid goes on to this one; false if it misses it.
bool meet_surface_ahead(inout Path path) {
    if (path.status != kStatusOk) return false;  // it was lost before
    // It stands on the layer that it searches if it has left this object.
    Hit hit = search(path.position, path.direction, !kNextObject, kNextObject);
    if (hit.distance < 0.0) {
        // Most paths meet no further glass. Over glass at the edge of the picture nobody knows.
        if (hit.status == kStatusLeftScreen) path.status = hit.status;
        return false;
    }
    path.position += hit.distance * path.direction;
    return cross_interface(path, normal_at(world_pixel(path.position)), false, object_material().ior);
}

void append(ivec2 texel) {
    uint i = atomicAdd(inside_length, 1u);
    if (i % PELLUCID_LIST_GROUP == 0u) atomicAdd(inside_groups[0], 1u);
    inside_pixels[i] = uint(texel.x) | uint(texel.y) << 16;
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
        uint status = path.status;
        meets = meet_surface_ahead(path);             // case 3
        if (!meets && path.status == status) return;  // case 2
    }
    store_world_refraction(texel, path);
    if (meets) append(texel);
}
