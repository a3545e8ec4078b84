#version 460
// Wang, "Image Space Real-time Multi-refraction Technology", 2014, chapter 3: the exit point of a
// refracted ray is searched in depth layers; jumps of a layer's depth ("fault zones") are told from
// surfaces by how far the stored depths on their two sides lie apart. Section numbers are the thesis's.
#extension GL_GOOGLE_include_directive : require
#include "techniques/technique_bindings.glsl"

#include "layers/pixel_list.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

layout(push_constant) uniform Push {
    vec4 box_low;  // of the object: x and y in view space, depth, m
    vec4 box_high;
    uint layer_count;
    uint linear_steps;
    uint binary_steps;
    uint reflections_per_exit;
};

#include "techniques/wang_2014/search.glsl"

// From inside the solid to its outside through `layer`; false if the path ends here.
bool leave_solid(inout Path path, uint layer, MaterialRecord material) {
    bool leaves_surface = false;
    for (uint reflection = 0u; reflection <= reflections_per_exit; ++reflection) {
        Hit hit = search(path.position, path.direction, layer, leaves_surface);
        if (hit.distance < 0.0) {
            path.status = hit.status;
            return false;
        }
        travel(path, hit.distance, material.sigma_a.rgb);
        if (cross_interface(path, normal_at(project(path.position), layer), true, material.ior)) return true;
        leaves_surface = true;  // total internal reflection: the same layer is searched again (3.6)
    }
    path.status = kStatusEventLimit;
    return false;
}

// From outside to the solid's next entry layer; false if the ray meets none.
bool enter_solid(inout Path path, uint layer, MaterialRecord material) {
    Hit hit = search(path.position, path.direction, layer, true);
    if (hit.distance < 0.0) {
        // Most paths meet no further glass. Over glass at the edge of the picture nobody knows.
        if (hit.status == kStatusLeftScreen) path.status = hit.status;
        return false;
    }
    path.position += hit.distance * path.direction;
    return cross_interface(path, normal_at(project(path.position), layer), false, material.ior);
}

void trace(inout Path path, ivec2 texel, vec2 pixel, Fragment first) {
    MaterialRecord material = material_of(first);
    vec3 first_position = view_position(pixel, first.depth);
    if (back_face(first.triangle)) {  // the entry before this exit is not there: an open mesh, or the eye inside
        travel(path, distance(path.position, first_position), material.sigma_a.rgb);
        cross_interface(path, view_normal(texel, 0u), true, material.ior);
        path.status = kStatusMissingLayer;
        return;
    }
    path.position = first_position;
    cross_interface(path, view_normal(texel, 0u), false, material.ior);
    for (uint exit_layer = 1u; leave_solid(path, exit_layer, material); exit_layer += 2u) {
        if (exit_layer + 2u >= layer_count) return;
        if (!enter_solid(path, exit_layer + 1u, material)) return;
    }
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;

    vec2 pixel = vec2(texel) + 0.5;
    Path path = camera_path(pixel);
    trace(path, texel, pixel, load_fragment(texel, 0u));
    store_refraction(texel, path);
}
