#ifndef PELLUCID_TECHNIQUES_RAY_RANGE_GLSL
#define PELLUCID_TECHNIQUES_RAY_RANGE_GLSL

// Distances to which a ray in view space can be followed in layers of the view. Needs: frame (FrameConstants).

// Distance at which a quantity that starts at `value` and changes by `rate` per metre reaches zero.
float reach_zero(float value, float rate) {
    return rate < 0.0 ? max(value, 0.0) / -rate : PELLUCID_EMPTY_DEPTH;
}

// Distance at which the ray leaves the current tile.
float distance_to_screen_edge(vec3 origin, vec3 direction) {
    bool orthographic = frame.orthographic != 0u;
    float depth = orthographic ? 1.0 : -origin.z;
    float depth_rate = orthographic ? 0.0 : -direction.z;
    vec2 top_left = film_point(vec2(0.0)), bottom_right = film_point(vec2(frame.width, frame.height));
    vec2 low = vec2(top_left.x, bottom_right.y), high = vec2(bottom_right.x, top_left.y);
    vec2 from_low = origin.xy - low * depth, from_low_rate = direction.xy - low * depth_rate;
    vec2 from_high = high * depth - origin.xy, from_high_rate = high * depth_rate - direction.xy;
    return min(min(reach_zero(from_low.x, from_low_rate.x), reach_zero(from_low.y, from_low_rate.y)),
               min(reach_zero(from_high.x, from_high_rate.x), reach_zero(from_high.y, from_high_rate.y)));
}

// Distance at which the ray leaves the depth range of the glass, extended by `margin` metres: t(Zmin) or t(Zmax),
// whichever lies ahead.
float distance_to_depth_edge(vec3 origin, vec3 direction, float margin) {
    float depth = -origin.z, depth_rate = -direction.z;
    return min(reach_zero(depth - frame.glass_near + margin, depth_rate),
               reach_zero(frame.glass_far + margin - depth, -depth_rate));
}

#endif
