#version 460
// Oliveira & Brauwers, "Real-Time Refraction Through Deformable Objects", I3D 2007. The exit point of the refracted
// ray is searched in the depths of the object's back faces. As in relief mapping of a height field, the search takes
// linear, then binary steps.
#extension GL_GOOGLE_include_directive : require
#include "techniques/technique_bindings.glsl"

#include "layers/pixel_list.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

layout(push_constant) uniform Push {
    uint linear_steps;
    uint binary_steps;
    uint interpolate;
};

#include "techniques/oliveira_brauwers_2007/back_layer.glsl"
#include "techniques/ray_range.glsl"

// Narrows the step in which the ray passed behind the layer. Returns the last distance in front of it.
float binary_search(vec3 origin, vec3 direction, float front, float behind) {
    for (uint i = 0u; i < binary_steps; ++i) {
        float middle = 0.5 * (front + behind);
        vec3 position = origin + middle * direction;
        if (-position.z > footprint(position).depth) behind = middle;
        else front = middle;
    }
    return front;
}

bool is_behind(vec3 position) { return -position.z > stored_depth(position); }

struct Hit {
    float distance;  // negative: no hit
    uint status;     // reason for a missing hit
};

// Finds where the ray passes behind the back layer.
Hit search(vec3 origin, vec3 direction) {
    float to_screen_edge = distance_to_screen_edge(origin, direction);
    // Extend the range by a step, so that a surface at its end is passed.
    float end = min(to_screen_edge, distance_to_depth_edge(origin, direction, largest_step()));
    float step_length = end / float(linear_steps);
    uint i = 1u;
    while (i <= linear_steps && !is_behind(origin + float(i) * step_length * direction)) ++i;
    if (i <= linear_steps) {
        float hit = binary_search(origin, direction, float(i - 1u) * step_length, float(i) * step_length);
        // An open object may have no back face nearby.
        if (stored_depth(origin + hit * direction) >= -0.5 * PELLUCID_EMPTY_DEPTH) return Hit(hit, kStatusOk);
    }
    bool over_glass = abs(stored_depth(origin + end * direction)) < PELLUCID_EMPTY_DEPTH;
    return Hit(-1.0, to_screen_edge <= end && over_glass ? kStatusLeftScreen : kStatusMissingLayer);
}

void trace(inout Path path, ivec2 texel, vec2 pixel, Fragment first) {
    MaterialRecord material = material_of(first);
    vec3 first_position = view_position(pixel, first.depth);
    if (back_face(first.triangle)) {  // the entry before this exit is missing: an open mesh, or the eye inside
        travel(path, distance(path.position, first_position), material.sigma_a.rgb);
        cross_interface(path, view_normal(texel, 0u), true, material.ior);
        path.status = kStatusMissingLayer;
        return;
    }
    path.position = first_position;
    cross_interface(path, view_normal(texel, 0u), false, material.ior);
    Hit hit = search(path.position, path.direction);
    if (hit.distance < 0.0) {
        path.status = hit.status;
        return;
    }
    travel(path, hit.distance, material.sigma_a.rgb);
    // The method has two interfaces. After total internal reflection the path ends with the event limit.
    if (!cross_interface(path, normal_at(path.position), true, material.ior)) path.status = kStatusEventLimit;
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;

    vec2 pixel = vec2(texel) + 0.5;
    Path path = camera_path(pixel);
    trace(path, texel, pixel, load_fragment(texel, 0u));
    store_refraction(texel, path);
}
