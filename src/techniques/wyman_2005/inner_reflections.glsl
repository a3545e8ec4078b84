// Total internal reflection between the image of the first surfaces and that of the back faces (3.3). The space in
// between counts as glass. Its walls are found in linear, then in binary steps. Only wyman_2005.comp includes this
// file.
#include "gpu/stretch.glsl"

// Side of the glass on which a point of a ray lies.
const int kInGlass = 0, kBehindBack = 1, kBeforeFront = 2, kBesideGlass = 3;

// Tolerance in pixels for the ray's own wall, since depths are those of texel centres.
const float kClearance = 1.5;

int side_at(Stretch s, float share) {
    ivec2 texel = texel_at(s, share);
    float back = wall_depth(texel, false), front = wall_depth(texel, true), depth = depth_at(s, share);
    if (front == PELLUCID_EMPTY_DEPTH || back == PELLUCID_EMPTY_DEPTH) return kBesideGlass;
    return depth > back ? kBehindBack : depth < front ? kBeforeFront : kInGlass;
}

// Follows the ray to the wall that it hits, and returns the wall's outward normal in `normal`. Returns false if the
// ray leaves the image first.
bool find_wall(inout Path path, vec3 view_direction, MaterialRecord material, out vec3 normal) {
    float depth = -path.position.z, rate = -path.direction.z;
    // Extend the range beyond its bounding walls, so that the ray passes them.
    float beyond = 0.01 * (frame.glass_far - frame.glass_near) + 1e-4 * frame.glass_far;
    float reach = rate > 0.0 ? frame.glass_far + beyond - depth
                             : depth - max(frame.glass_near - beyond, frame.near_plane);
    // A ray parallel to the image plane ends at the border.
    float range = min(max(reach, 0.0) / max(abs(rate), 1e-6), 1e3 * frame.glass_far);
    Stretch s = stretch_of(path.position, path.position + range * path.direction);
    float end = share_within_picture(s);
    if (end < 0.0) return false;
    float inside = 0.0, outside = -1.0;
    bool clear = false;  // true once the ray has left the reflecting wall
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

// Follows total reflections until the ray refracts. Returns false if the last reflection is still total, or the ray
// leaves the image; `normal` is then the normal for leaving.
bool bounce(inout Path path, vec3 view_direction, inout vec3 normal, MaterialRecord material) {
    for (uint i = 0u; i < kInnerReflections; ++i) {
        Path next = path;
        if (cross_interface(next, normal, true, material.ior)) {
            path = next;
            return true;
        }
        // The exit was a guess; move it to the wall in the image.
        vec2 pixel = project(next.position);
        if (i == 0u) next.position = view_position(pixel, back_depth_at(ivec2(floor(pixel))));
        vec3 met;
        if (!find_wall(next, view_direction, material, met)) return false;
        path = next;
        normal = met;
    }
    return false;
}
