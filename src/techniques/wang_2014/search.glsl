#ifndef PELLUCID_TECHNIQUES_WANG_2014_SEARCH_GLSL
#define PELLUCID_TECHNIQUES_WANG_2014_SEARCH_GLSL

// Search of a layer along a ray: Wang 2014, sections 3.3 and 3.5. Needs: technique_bindings.glsl; linear_steps,
// binary_steps, fault_size, box_low, box_high.

#include "techniques/ray_range.glsl"
#include "techniques/wang_2014/merged_layers.glsl"

// The path's length is the number of search steps that the pixel has taken, instead of metres.
layout(constant_id = 4) const bool kCountsSteps = false;
uint steps_taken = 0u;

// `before`: the path's length before the search.
void note_steps(inout Path path, float before) {
    if (kCountsSteps) path.length_inside = before + float(steps_taken);
}

// First step of a ray, in linear steps, to clear its own surface (3.6). Values from 0.02 to 0.5 are equally accurate.
const float kFirstStep = 0.1;

// A view-space ray in screen coordinates, linear in its distance: the homogeneous pixel coordinate (x, y, w) and the
// depth.
struct ScreenRay {
    vec3 pixel, pixel_rate;
    float depth, depth_rate;
};

ScreenRay screen_ray(vec3 origin, vec3 direction) {
    bool orthographic = frame.orthographic != 0u;
    float w = orthographic ? 1.0 : -origin.z, w_rate = orthographic ? 0.0 : -direction.z;
    vec2 scale = vec2(1.0, -1.0) / frame.film.zw, corner = film_point(vec2(0.0));
    return ScreenRay(vec3((origin.xy - corner * w) * scale, w), vec3((direction.xy - corner * w_rate) * scale, w_rate),
                     -origin.z, -direction.z);
}

vec2 pixel_at(ScreenRay ray, float distance) {
    vec3 p = ray.pixel + distance * ray.pixel_rate;
    return p.xy * (1.0 / p.z);
}

float depth_at(ScreenRay ray, float distance) { return ray.depth + distance * ray.depth_rate; }

// Range of distances in the object's box, extended by a step on all sides; x >= 0. x > y if the ray misses the box.
vec2 distances_in_box(vec3 origin, vec3 direction) {
    origin.z = -origin.z;
    direction.z = -direction.z;
    vec3 margin = vec3(fault_size);
    vec3 inverse = 1.0 / mix(direction, vec3(1e-12), lessThan(abs(direction), vec3(1e-12)));
    vec3 low = box_low.xyz - margin;
    if (frame.orthographic == 0u) low.z = max(low.z, frame.near_plane);
    vec3 a = (low - origin) * inverse, b = (box_high.xyz + margin - origin) * inverse;
    vec3 near = min(a, b), far = max(a, b);
    return vec2(max(max(near.x, near.y), max(near.z, 0.0)), min(min(far.x, far.y), far.z));
}

struct Hit {
    float distance;  // negative: no hit
    uint layer;      // that holds the surface
    uint status;     // reason for a missing hit
};

// The searched part of a ray, and the current linear step from `before` to `after`.
struct Walk {
    ScreenRay ray;
    float start, last;  // distances; start >= last: nothing to search
    float end;          // of the steps; nearer than `last` if nothing can be hit between them
    float step_length, before, after;
    uint next_step;
    bool left_screen;  // `last` is at the edge of the image
};

// `on_layer`: the ray starts on the searched layer and takes a small step first. `from_afar`: it starts anywhere.
// Neither: it starts in front of the layer.
Walk begin_walk(vec3 world_origin, vec3 world_direction, bool on_layer, bool from_afar) {
    vec3 origin = (frame.view_from_world * vec4(world_origin, 1.0)).xyz;
    vec3 direction = mat3(frame.view_from_world) * world_direction;
    float to_screen_edge = distance_to_screen_edge(origin, direction);
    vec2 in_box = distances_in_box(origin, direction);
    Walk walk;
    walk.ray = screen_ray(origin, direction);
    walk.start = from_afar ? in_box.x : 0.0;
    walk.last = min(to_screen_edge, in_box.y);
    walk.left_screen = to_screen_edge <= walk.last;
    walk.end = walk.start < walk.last ? walk.last : walk.start;
    walk.step_length = max((walk.last - walk.start) / float(linear_steps), fault_size);
    walk.before = walk.after = on_layer ? kFirstStep * walk.step_length : walk.start;
    walk.next_step = 1u;
    return walk;
}

bool step_on(inout Walk walk) {
    if (!(walk.after < walk.end)) return false;
    walk.before = walk.after;
    walk.after = min(walk.start + float(walk.next_step) * walk.step_length, walk.end);
    ++walk.next_step;
    ++steps_taken;
    return true;
}

// True if the ray is behind the searched layer, "-" in the thesis.
bool is_behind(ScreenRay ray, float distance) {
    return depth_at(ray, distance) > stored_depth(pixel_at(ray, distance), layer);
}

// Steps on until the ray passes from the front of the searched layer to behind it. Returns false if it does not.
bool pass_layer(inout Walk walk, inout bool behind) {
    bool passed = false;
    while (!passed && step_on(walk)) {
        bool now_behind = is_behind(walk.ray, walk.after);
        passed = now_behind && !behind;
        behind = now_behind;  // false: in front, or out of a fault zone
    }
    return passed;
}

// Narrows the current step, which passes a layer to behind it or to its front. Returns the last distance before the
// crossing. `jump`: difference of the layer's depths at both ends.
float binary_search(Walk walk, uint crossed, bool to_front, out float jump) {
    float before = walk.before, after = walk.after;
    float depth_before = footprint(pixel_at(walk.ray, before), crossed).depth;
    float depth_after = footprint(pixel_at(walk.ray, after), crossed).depth;
    for (uint i = 0u; i < binary_steps; ++i) {
        ++steps_taken;
        float middle = 0.5 * (before + after);
        float depth = footprint(pixel_at(walk.ray, middle), crossed).depth;
        if ((depth_at(walk.ray, middle) > depth) != to_front) {
            after = middle;
            depth_after = depth;
        } else {
            before = middle;
            depth_before = depth;
        }
    }
    jump = abs(depth_after - depth_before);
    return before;
}

Hit no_hit(Walk walk) {
    // Beside the object the image lacks nothing: the ray has left the object.
    bool over_glass = abs(stored_depth(pixel_at(walk.ray, walk.last), layer)) < PELLUCID_EMPTY_DEPTH;
    bool unknown = walk.start < walk.last && walk.left_screen && over_glass;
    return Hit(-1.0, layer, unknown ? kStatusLeftScreen : kStatusMissingLayer);
}

// Pixel coordinate of a point in world space.
vec2 world_pixel(vec3 position) { return project((frame.view_from_world * vec4(position, 1.0)).xyz); }

#endif
