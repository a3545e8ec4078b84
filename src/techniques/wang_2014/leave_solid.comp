#version 460
// Rays inside the object look for their way out through one layer (sections 3.3 to 3.6).
#extension GL_GOOGLE_include_directive : require
#include "techniques/wang_2014/ray_state.glsl"
#include "techniques/wang_2014/search.glsl"
#include "techniques/wang_2014/first_surface.glsl"

layout(constant_id = 0) const bool kFromEye = false;  // the rays are view rays that have yet to come in

layout(std430, set = 0, binding = 17) buffer Outside {
    uint outside_groups[3];
    uint outside_length;
    uint outside_pixels[];
};
layout(std430, set = 0, binding = 18) buffer Reflected {
    uint reflected_groups[3];
    uint reflected_length;
    uint reflected_pixels[];
};

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;

    Path path = kFromEye ? pass_first_surface(texel) : load_path(texel);
    if (kFromEye && path.status != kStatusOk) {
        store_world_refraction(texel, path);
        return;
    }
    // A ray that was reflected stands on the layer that it searches, one that has come in does not.
    bool reflected = path.status == kStatusEventLimit;
    Hit hit = search(path.position, path.direction, reflected, false);
    if (hit.distance < 0.0) {
        path.status = hit.status;
        store_world_refraction(texel, path);
        return;
    }
    MaterialRecord material = object_material();
    travel(path, hit.distance, material.sigma_a.rgb);
    bool leaves = cross_interface(path, normal_at(world_pixel(path.position)), true, material.ior);
    path.status = leaves ? kStatusOk : kStatusEventLimit;  // which a further search may still resolve
    store_world_refraction(texel, path);

    uint word = uint(texel.x) | uint(texel.y) << 16;
    if (leaves) {
        uint i = atomicAdd(outside_length, 1u);
        if (i % PELLUCID_LIST_GROUP == 0u) atomicAdd(outside_groups[0], 1u);
        outside_pixels[i] = word;
    } else if (last_reflection == 0u) {
        uint i = atomicAdd(reflected_length, 1u);
        if (i % PELLUCID_LIST_GROUP == 0u) atomicAdd(reflected_groups[0], 1u);
        reflected_pixels[i] = word;
    }
}
