#ifndef PELLUCID_GPU_DEPTH_SEARCH_GLSL
#define PELLUCID_GPU_DEPTH_SEARCH_GLSL

// Intersects a ray with a depth image by linear, then binary steps (Wyman, "Interactive Image-Space Refraction of
// Nearby Geometry", 2005). Needs: gpu/frame.glsl, and `float stored_depth(ivec2 texel)`, m along the view's axis.
#include "gpu/stretch.glsl"

bool is_behind(Stretch s, float share) { return depth_at(s, share) > stored_depth(texel_at(s, share)); }

// Whether the texels before and after a crossing show one surface. Their depths must not differ by more than twice the
// difference to the next texel. Otherwise the ray passes behind the edge of an object.
bool one_surface(ivec2 front, ivec2 behind) {
    if (front == behind) return true;
    float at_behind = stored_depth(behind);
    ivec2 beyond = clamp(2 * behind - front, ivec2(0), ivec2(frame.width, frame.height) - 1);
    float slope = abs(stored_depth(beyond) - at_behind);
    return abs(stored_depth(front) - at_behind) <= 2.0 * slope + 1e-4 * at_behind;
}

// Share of the stretch at which it meets an opaque surface from in front; negative: no hit. `behind`: whether the ray
// is behind the depth image; pass it on from stretch to stretch.
float search(Stretch s, uint linear_steps, uint binary_steps, inout bool behind) {
    float end = share_within_picture(s), before = 0.0;
    if (end < 0.0) return -1.0;
    for (uint i = 1u; i <= linear_steps; ++i) {
        float after = end * float(i) / float(linear_steps);
        if (is_behind(s, after) != behind) {
            float low = before, high = after;
            for (uint k = 0u; k < binary_steps; ++k) {
                float middle = 0.5 * (low + high);
                if (is_behind(s, middle) == behind) low = middle;
                else high = middle;
            }
            if (!behind && one_surface(texel_at(s, low), texel_at(s, high))) return high;
            behind = !behind;
        }
        before = after;
    }
    return -1.0;
}

#endif
