#version 460
// Rays outside the object look for a way in through one layer: again into the object that they have left (3.5), or
// from object to object (3.7).
#extension GL_GOOGLE_include_directive : require
#include "techniques/wang_2014/ray_state.glsl"
#include "techniques/wang_2014/search.glsl"

layout(constant_id = 0) const bool kFirstObject = false;  // no ray has met anything yet

layout(set = 0, binding = 12, r32ui) readonly uniform uimage2DArray seen_triangle;  // layer 0 of all solids together
layout(std430, set = 0, binding = 17) buffer Inside {
    uint inside_groups[3];
    uint inside_length;
    uint inside_pixels[];
};

// The view ray of a pixel at the object's first surface; false if the eye sees another surface there.
bool meet_first_surface(ivec2 texel, out Path path) {
    uint seen = imageLoad(seen_triangle, ivec3(texel, 0)).r;
    if (seen == PELLUCID_NO_TRIANGLE || find_object(triangle_index(seen)) != object) return false;

    vec2 pixel = vec2(texel) + 0.5;
    path = camera_path(pixel);
    path.position = (frame.world_from_view * vec4(path.position, 1.0)).xyz;
    path.direction = mat3(frame.world_from_view) * path.direction;
    Fragment first = load_fragment(texel, 0u);
    MaterialRecord material = object_material();
    vec3 position = (frame.world_from_view * vec4(view_position(pixel, first.depth), 1.0)).xyz;
    bool leaving = back_face(first.triangle);
    // The entry before an exit may not be there: an open mesh, or the eye inside.
    if (leaving) travel(path, distance(path.position, position), material.sigma_a.rgb);
    path.position = position;
    path.status = leaving ? kStatusMissingLayer : kStatusOk;
    cross_interface(path, unpack_unit_vector(imageLoad(layer_normal, ivec3(texel, 0)).r), leaving, material.ior);
    return true;
}

// A ray that has left a solid goes on to this one; false if it misses it.
bool meet_surface_ahead(inout Path path) {
    if (path.status != kStatusOk) return false;  // it was lost before
    // It stands on the layer that it searches if it has left this object.
    Hit hit = search(path.position, path.direction, layer, layer > 0u, layer == 0u);
    if (hit.distance < 0.0) {
        // Most paths meet no further glass. Over glass at the edge of the picture nobody knows.
        if (hit.status == kStatusLeftScreen) path.status = hit.status;
        return false;
    }
    path.position += hit.distance * path.direction;
    return cross_interface(path, normal_at(world_pixel(path.position), layer), false, object_material().ior);
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;

    Path path;
    bool starts = kFirstObject || (layer == 0u && imageLoad(path_events, ivec3(texel, 0)).r == 0u);
    bool meets;
    if (starts) {
        meets = meet_first_surface(texel, path);  // case 1 of 3.7
        if (!meets) return;
    } else {
        path = load_path(texel);
        uint status = path.status;
        meets = meet_surface_ahead(path);  // case 3
        if (!meets && path.status == status) return;  // case 2
    }
    store_world_refraction(texel, path);
    if (!meets || path.status != kStatusOk) return;
    uint i = atomicAdd(inside_length, 1u);
    if (i % PELLUCID_LIST_GROUP == 0u) atomicAdd(inside_groups[0], 1u);
    inside_pixels[i] = uint(texel.x) | uint(texel.y) << 16;
}
