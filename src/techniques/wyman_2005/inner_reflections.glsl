// Total internal reflection by bouncing between the picture of the first surfaces and that of the back faces (3.3). What
// lies between the two counts as glass; its walls are found in linear, then in binary steps.
// Included by wyman_2005.comp alone.
#include "gpu/stretch.glsl"

// Which wall of the glass a point of a ray lies behind.
const int kInGlass = 0, kBehindBack = 1, kBeforeFront = 2, kBesideGlass = 3;

// Pixels within which the wall that the ray comes from may seem to lie before it: depths are those of texel centres.
const float kClearance = 1.5;

int side_at(Stretch s, float share) {
    ivec2 texel = texel_at(s, share);
    float back = wall_depth(texel, false), front = wall_depth(texel, true), depth = depth_at(s, share);
    if (front == PELLUCID_EMPTY_DEPTH || back == PELLUCID_EMPTY_DEPTH) return kBesideGlass;
    return depth > back ? kBehindBack : depth < front ? kBeforeFront : kInGlass;
}

// Follows the ray to the wall that it meets, whose outward normal it gives. False: it leaves the picture before.
bool find_wall(inout Path path, vec3 view_direction, MaterialRecord material, out vec3 normal) {
    float depth = -path.position.z, rate = -path.direction.z;
    // A little beyond the walls that bound the range, to see the ray pass them.
    float beyond = 0.01 * (frame.glass_far - frame.glass_near) + 1e-4 * frame.glass_far;
    float reach = rate > 0.0 ? frame.glass_far + beyond - depth
                             : depth - max(frame.glass_near - beyond, frame.near_plane);
    // Along the picture the ray ends at its border.
    float range = min(max(reach, 0.0) / max(abs(rate), 1e-6), 1e3 * frame.glass_far);
    Stretch s = stretch_of(path.position, path.position + range * path.direction);
    float end = share_within_picture(s);
    if (end < 0.0) return false;
    float inside = 0.0, outside = -1.0;
    bool clear = false;  // of the wall that has reflected the ray
    for (uint i = 1u; i <= linear_steps && outside < 0.0; ++i) {
        float share = end * float(i) / float(linear_steps);
        if (side_at(s, share) == kInGlass) {
            inside = share;
            clear = true;
        } else if (clear || distance(pixel_at(s, share), s.from) > kClearance) {
            outside = share;
        }
    }
    if (outside < 0.0) return false;
    int side = side_at(s, outside);
    for (uint k = 0u; k < binary_steps; ++k) {
        float middle = 0.5 * (inside + outside);
        int found = side_at(s, middle);
        if (found == kInGlass) {
            inside = middle;
        } else {
            outside = middle;
            side = found;
        }
    }
    travel(path, distance(path.position, position_at(s, outside)), material.sigma_a.rgb);
    bool front = side == kBeforeFront;
    if (side == kBesideGlass || !exit_normal(path.position, front, normal))
        normal = edge_normal(path.direction, view_direction);
    return true;
}

// Follows total reflections until one refracts. False: the last of those that are followed is still reflected, or the
// picture ends; then `normal` is the one to leave by.
bool bounce(inout Path path, vec3 view_direction, inout vec3 normal, MaterialRecord material) {
    for (uint i = 0u; i < kInnerReflections; ++i) {
        Path next = path;
        if (cross_interface(next, normal, true, material.ior)) {
            path = next;
            return true;
        }
        // The exit was guessed: the picture knows where its wall is.
        vec2 pixel = project(next.position);
        if (i == 0u) next.position = view_position(pixel, back_depth_at(ivec2(floor(pixel))));
        vec3 met;
        if (!find_wall(next, view_direction, material, met)) return false;
        path = next;
        normal = met;
    }
    return false;
}
