#ifndef PELLUCID_TECHNIQUES_WANG_2014_SEARCH_GLSL
#define PELLUCID_TECHNIQUES_WANG_2014_SEARCH_GLSL

// Search of a layer along a ray: Wang 2014, sections 3.3 and 3.5. Needs: technique_bindings.glsl; linear_steps,
// binary_steps, box_low, box_high.

// SIZE of the thesis, in metres of depth. Larger depth differences between neighbouring texels, or between the two
// ends of a binary search, mean different surfaces.
float fault_size() { return (box_high.z - box_low.z) / float(linear_steps); }

#include "techniques/ray_range.glsl"
#include "techniques/wang_2014/merged_layers.glsl"

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
    vec3 margin = vec3(fault_size());
    vec3 inverse = 1.0 / mix(direction, vec3(1e-12), lessThan(abs(direction), vec3(1e-12)));
    vec3 low = box_low.xyz - margin;
    if (frame.orthographic == 0u) low.z = max(low.z, frame.near_plane);
    vec3 a = (low - origin) * inverse, b = (box_high.xyz + margin - origin) * inverse;
    vec3 near = min(a, b), far = max(a, b);
    return vec2(max(max(near.x, near.y), max(near.z, 0.0)), min(min(far.x, far.y), far.z));
}

struct Hit {
    float distance;  // negative: no hit
    uint status;     // reason for a missing hit
};

// Narrows the interval between a point in front of the layer and one behind it. Returns the last distance in front.
// `jump`: difference of the layer's depths at both ends.
float binary_search(ScreenRay ray, float before, float after, out float jump) {
    float depth_before = footprint(pixel_at(ray, before)).depth;
    float depth_after = footprint(pixel_at(ray, after)).depth;
    for (uint i = 0u; i < binary_steps; ++i) {
        float middle = 0.5 * (before + after);
        float depth = footprint(pixel_at(ray, middle)).depth;
        if (depth_at(ray, middle) > depth) {
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

// Pixel coordinate of a point in world space.
vec2 world_pixel(vec3 position) { return project((frame.view_from_world * vec4(position, 1.0)).xyz); }

// Searches the layer along a world-space ray, first in linear, then in binary steps (3.3, 3.5). Both entries and exits
// are hit from the front: a ray that appears from behind leaves a fault zone. `on_layer`: the ray starts on the
// searched layer. `from_afar`: it starts anywhere. Neither: it starts in front of the layer.
Hit search(vec3 world_origin, vec3 world_direction, bool on_layer, bool from_afar) {
    vec3 origin = (frame.view_from_world * vec4(world_origin, 1.0)).xyz;
    vec3 direction = mat3(frame.view_from_world) * world_direction;
    ScreenRay ray = screen_ray(origin, direction);
    float to_screen_edge = distance_to_screen_edge(origin, direction);
    vec2 in_box = distances_in_box(origin, direction);
    float start = from_afar ? in_box.x : 0.0;
    float last = min(to_screen_edge, in_box.y);
    if (!(start < last)) return Hit(-1.0, kStatusMissingLayer);
    // Beyond the farthest entry of the image there is nothing to hit.
    bool entries = layer % 2u == 0u;
    float end = entries ? min(last, reach_zero(uintBitsToFloat(farthest_entry) + fault_size() - ray.depth, -ray.depth_rate)) : last;
    float step_length = max((last - start) / float(linear_steps), fault_size());

    // True if the ray is behind the layer, "-" in the thesis. A ray that starts on layer 1 is in front of layer 2. A
    // ray that starts on the searched layer takes a small step first.
    float before = on_layer ? kFirstStep * step_length : start;
    bool behind = (on_layer || from_afar) && depth_at(ray, before) > stored_depth(pixel_at(ray, before));

    // The binary search stays outside the linear loop: some drivers spend its time in every iteration, executed or
    // not.
    float after = before;
    for (uint i = 1u; after < end;) {
        bool passed = false;  // from the front of the layer to behind it
        for (; !passed && after < end; ++i) {
            before = after;
            after = min(start + float(i) * step_length, end);
            bool now_behind = depth_at(ray, after) > stored_depth(pixel_at(ray, after));
            passed = now_behind && !behind;
            behind = now_behind;  // false: in front, or out of a fault zone
        }
        if (!passed) break;
        float jump;
        float hit = binary_search(ray, before, after, jump);
        if (jump <= fault_size()) return Hit(hit, kStatusOk);  // case 3; otherwise case 2: below the fault
    }
    // Beside the object the image lacks nothing: the ray has left the object.
    bool over_glass = abs(stored_depth(pixel_at(ray, last))) < PELLUCID_EMPTY_DEPTH;
    return Hit(-1.0, to_screen_edge <= last && over_glass ? kStatusLeftScreen : kStatusMissingLayer);
}

#endif
