#version 460
// Rays inside the object search one layer for their exit (sections 3.3 to 3.6).
#extension GL_GOOGLE_include_directive : require
#include "techniques/wang_2014/ray_state.glsl"
#include "techniques/wang_2014/search.glsl"
#include "techniques/wang_2014/search_exit.glsl"
#include "techniques/wang_2014/first_surface.glsl"

layout(constant_id = 0) const bool kFromEye = false;  // the rays are view rays before the first surface

PELLUCID_APPENDED_LIST(Outside, 17, outside_groups, outside_length, outside_pixels, append_outside)
PELLUCID_APPENDED_LIST(Reflected, 18, reflected_groups, reflected_length, reflected_pixels, append_reflected)

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;

    Path path = kFromEye ? pass_first_surface(texel) : load_path(texel);
    if (kFromEye && path.status != kStatusOk) {
        store_world_refraction(texel, path);
        return;
    }
    // A reflected ray starts on the searched layer, a ray that has just entered does not.
    bool reflected = path.status == kStatusEventLimit;
    float before = path.length_inside;
    Hit hit = search_exit(path.position, path.direction, reflected);
    if (hit.distance < 0.0) {
        path.status = hit.status;
        note_steps(path, before);
        store_world_refraction(texel, path);
        return;
    }
    MaterialRecord material = object_material();
    travel(path, hit.distance, material.sigma_a.rgb);
    bool leaves = cross_interface(path, normal_at(world_pixel(path.position), hit.layer), true, material.ior);
    path.status = leaves ? kStatusOk : kStatusEventLimit;  // a further search may still resolve kStatusEventLimit
    note_steps(path, before);
    store_world_refraction(texel, path);

    if (leaves) append_outside(texel);
    else if (last_reflection == 0u) append_reflected(texel);
}
