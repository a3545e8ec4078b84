#ifndef PELLUCID_TECHNIQUES_OLIVEIRA_BRAUWERS_2007_BACK_LAYER_GLSL
#define PELLUCID_TECHNIQUES_OLIVEIRA_BRAUWERS_2007_BACK_LAYER_GLSL

// Reads the back layer under a point of a ray. Needs: technique_bindings.glsl, linear_steps, interpolate.

layout(set = 0, binding = 10, r32f) readonly uniform image2DArray back_depth;
layout(set = 0, binding = 11, r32ui) readonly uniform uimage2DArray back_normal;

// The depth of a linear step, metres. Neighbouring depths of one surface differ by less.
float largest_step() { return (frame.glass_far - frame.glass_near) / float(linear_steps); }

ivec2 texel_under(vec3 position) {
    return clamp(ivec2(floor(project(position))), ivec2(0), ivec2(frame.width, frame.height) - 1);
}

// Beside the object a ray is outside, so it must count as behind the exit surface.
float texel_depth(int x, int y) {
    float depth = imageLoad(back_depth, ivec3(x, y, 0)).r;
    return depth == PELLUCID_EMPTY_DEPTH ? -PELLUCID_EMPTY_DEPTH : depth;
}

float stored_depth(vec3 position) {
    ivec2 texel = texel_under(position);
    return texel_depth(texel.x, texel.y);
}

// The four texels around a position with bilinear weights (low x first, then low y), and their weighted depth. Texels
// across a depth discontinuity from the nearest texel show another surface and have weight 0.
struct Footprint {
    ivec2 low, high;
    vec4 weights;
    float depth;
};

Footprint footprint(vec3 position) {
    ivec2 last = ivec2(frame.width, frame.height) - 1;
    vec2 point = clamp(project(position) - 0.5, vec2(0.0), vec2(last));
    ivec2 low = ivec2(point), high = min(low + 1, last);
    vec2 share = point - vec2(low);
    vec2 nearest_share = vec2(greaterThanEqual(share, vec2(0.5)));
    if (interpolate == 0u) share = nearest_share;

    vec4 depths = vec4(texel_depth(low.x, low.y), texel_depth(high.x, low.y), texel_depth(low.x, high.y),
                       texel_depth(high.x, high.y));
    vec2 nearest_row = nearest_share.y == 0.0 ? depths.xy : depths.zw;
    float nearest = nearest_share.x == 0.0 ? nearest_row.x : nearest_row.y;
    vec4 weights = vec4(1.0 - share.x, share.x, 1.0 - share.x, share.x) *
                   vec4(1.0 - share.yy, share.yy);
    weights *= vec4(lessThanEqual(abs(depths - nearest), vec4(largest_step())));
    weights /= dot(weights, vec4(1.0));
    return Footprint(low, high, weights, dot(weights, depths));
}

vec3 texel_normal(int x, int y) {
    return mat3(frame.view_from_world) * unpack_unit_vector(imageLoad(back_normal, ivec3(x, y, 0)).r);
}

// Unit normal of the surface under a position, in view space. The surface must exist.
vec3 normal_at(vec3 position) {
    Footprint around = footprint(position);
    vec3 sum = around.weights.x * texel_normal(around.low.x, around.low.y) +
               around.weights.y * texel_normal(around.high.x, around.low.y) +
               around.weights.z * texel_normal(around.low.x, around.high.y) +
               around.weights.w * texel_normal(around.high.x, around.high.y);
    ivec2 nearest = texel_under(position);
    // If opposite normals cancel out, use the nearest one.
    return dot(sum, sum) > 1e-12 ? normalize(sum) : texel_normal(nearest.x, nearest.y);
}

#endif
