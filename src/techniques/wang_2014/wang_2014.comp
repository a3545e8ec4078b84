#version 460
// Wang, "Image Space Real-time Multi-refraction Technology", 2014, chapter 3: the exit point of a
// refracted ray is searched in depth layers; jumps of a layer's depth ("fault zones") are told from
// surfaces by how far the stored depths on their two sides lie apart. Section numbers are the thesis's.
#extension GL_GOOGLE_include_directive : require
#include "techniques/technique_bindings.glsl"

#include "layers/pixel_list.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

layout(push_constant) uniform Push {
    uint layer_count;
    uint linear_steps;
    uint binary_steps;
    uint reflections_per_exit;
};

// How much of a linear step a ray takes first, to get clear of the surface it starts from (3.6).
// Anything from 0.02 to 0.5 is as accurate.
const float kFirstStep = 0.1;

#include "techniques/wang_2014/merged_layers.glsl"

// Distance to where a quantity that starts at `value` and changes at `rate` per metre reaches zero.
float reach_zero(float value, float rate) {
    return rate < 0.0 ? max(value, 0.0) / -rate : PELLUCID_EMPTY_DEPTH;
}

// How far the ray stays within the picture.
float distance_to_screen_edge(vec3 origin, vec3 direction) {
    bool orthographic = frame.orthographic != 0u;
    float depth = orthographic ? 1.0 : -origin.z;
    float depth_rate = orthographic ? 0.0 : -direction.z;
    vec2 low = vec2(frame.film.x, frame.film.y - float(frame.height) * frame.film.w);
    vec2 high = vec2(frame.film.x + float(frame.width) * frame.film.z, frame.film.y);
    vec2 from_low = origin.xy - low * depth, from_low_rate = direction.xy - low * depth_rate;
    vec2 from_high = high * depth - origin.xy, from_high_rate = high * depth_rate - direction.xy;
    return min(min(reach_zero(from_low.x, from_low_rate.x), reach_zero(from_low.y, from_low_rate.y)),
               min(reach_zero(from_high.x, from_high_rate.x), reach_zero(from_high.y, from_high_rate.y)));
}

// How far the ray stays within the depth range of the glass, with a step to spare at either end.
float distance_to_depth_edge(vec3 origin, vec3 direction) {
    float margin = fault_size();
    float depth = -origin.z, depth_rate = -direction.z;
    return min(reach_zero(depth - frame.glass_near + margin, depth_rate),
               reach_zero(frame.glass_far + margin - depth, -depth_rate));
}

struct Hit {
    float distance;  // negative: none
    uint status;     // why there is none
};

// Narrows a change of side between two distances; returns the last distance on the near side of it.
// `behind_before` is the side of the ray before the change. `jump` is how far apart the depths on
// the two sides of the change lie.
float binary_search(vec3 origin, vec3 direction, uint layer, bool behind_before, float before, float after,
                    out float jump) {
    float depth_before = footprint(origin + before * direction, layer).depth;
    float depth_after = footprint(origin + after * direction, layer).depth;
    for (uint i = 0u; i < binary_steps; ++i) {
        float middle = 0.5 * (before + after);
        vec3 position = origin + middle * direction;
        float depth = footprint(position, layer).depth;
        if ((-position.z > depth) == behind_before) {
            before = middle;
            depth_before = depth;
        } else {
            after = middle;
            depth_after = depth;
        }
    }
    jump = abs(depth_after - depth_before);
    return before;
}

// Searches `layer` along the ray, first in linear, then in binary steps (3.3, 3.5). Entries and exits
// alike are met from in front: a ray that comes up from behind comes out from below a fault zone.
Hit search(vec3 origin, vec3 direction, uint layer, bool leaves_surface) {
    float to_screen_edge = distance_to_screen_edge(origin, direction);
    float end = min(to_screen_edge, distance_to_depth_edge(origin, direction));
    float step_length = end / float(linear_steps);

    // Which side of the layer the ray is on; "-" of the thesis is true. A ray that starts on layer 1
    // is in front of layer 2. A ray that starts on the searched layer takes a small step first.
    float before = leaves_surface ? kFirstStep * step_length : 0.0;
    vec3 start = origin + before * direction;
    bool behind = leaves_surface && -start.z > stored_depth(start, layer);

    for (uint i = 1u; i <= linear_steps; ++i) {
        float after = float(i) * step_length;
        vec3 position = origin + after * direction;
        if ((-position.z > stored_depth(position, layer)) != behind) {
            float jump;
            float hit = binary_search(origin, direction, layer, behind, before, after, jump);
            if (!behind && jump <= fault_size()) return Hit(hit, kStatusOk);  // case 3
            behind = !behind;  // case 2: below the fault, or out from under it again
        }
        before = after;
    }
    // Beside the object nothing is missing from the picture: the ray has left unseen.
    bool over_glass = abs(stored_depth(origin + end * direction, layer)) < PELLUCID_EMPTY_DEPTH;
    return Hit(-1.0, to_screen_edge <= end && over_glass ? kStatusLeftScreen : kStatusMissingLayer);
}

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
        if (cross_interface(path, normal_at(path.position, layer), true, material.ior)) return true;
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
    return cross_interface(path, normal_at(path.position, layer), false, material.ior);
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
