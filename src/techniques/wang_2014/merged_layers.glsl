#ifndef PELLUCID_TECHNIQUES_WANG_2014_MERGED_LAYERS_GLSL
#define PELLUCID_TECHNIQUES_WANG_2014_MERGED_LAYERS_GLSL

// Reading the layers that merge_layers.comp has merged: depths and normals under a point of a ray.
// Needs: technique_bindings.glsl, linear_steps.

layout(set = 0, binding = 10, r32f) readonly uniform image2DArray merged_depth;

// SIZE of the thesis in metres of depth: depths on one surface change by no more than this from
// texel to texel, or between the two ends of a binary search.
float fault_size() { return (frame.glass_far - frame.glass_near) / float(linear_steps); }

ivec2 texel_under(vec3 position) {
    return clamp(ivec2(floor(project(position))), ivec2(0), ivec2(frame.width, frame.height) - 1);
}

float stored_depth(vec3 position, uint layer) {
    return imageLoad(merged_depth, ivec3(texel_under(position), layer)).r;
}

float texel_depth(int x, int y, uint layer) { return imageLoad(merged_depth, ivec3(x, y, layer)).r; }

// The four texels around a position with their bilinear weights (low x first, then low y), and the
// depth they give. A texel across a fault zone from the nearest one shows another surface and has
// no weight.
struct Footprint {
    ivec2 low, high;
    vec4 weights;
    float depth;
};

Footprint footprint(vec3 position, uint layer) {
    ivec2 last = ivec2(frame.width, frame.height) - 1;
    vec2 point = clamp(project(position) - 0.5, vec2(0.0), vec2(last));
    ivec2 low = ivec2(point), high = min(low + 1, last);
    vec2 share = point - vec2(low), rest = 1.0 - share;

    vec4 depths = vec4(texel_depth(low.x, low.y, layer), texel_depth(high.x, low.y, layer),
                       texel_depth(low.x, high.y, layer), texel_depth(high.x, high.y, layer));
    vec2 nearest_row = share.y < 0.5 ? depths.xy : depths.zw;
    float nearest = share.x < 0.5 ? nearest_row.x : nearest_row.y;
    vec4 weights = vec4(rest.x, share.x, rest.x, share.x) * vec4(rest.yy, share.yy);
    weights *= vec4(lessThanEqual(abs(depths - nearest), vec4(fault_size())));
    weights /= dot(weights, vec4(1.0));
    return Footprint(low, high, weights, dot(weights, depths));
}

// The normal behind a merged depth: of the layer itself, or of the one of its kind that stands in for it.
vec3 merged_normal(ivec2 texel, uint layer) {
    while (layer >= 2u && imageLoad(layer_triangle, ivec3(texel, layer)).r == PELLUCID_NO_TRIANGLE) layer -= 2u;
    return view_normal(texel, layer);
}

vec3 normal_at(vec3 position, uint layer) {
    Footprint around = footprint(position, layer);
    vec3 sum = around.weights.x * merged_normal(around.low, layer) +
               around.weights.y * merged_normal(ivec2(around.high.x, around.low.y), layer) +
               around.weights.z * merged_normal(ivec2(around.low.x, around.high.y), layer) +
               around.weights.w * merged_normal(around.high, layer);
    // Opposite normals may cancel out; then any of them will do.
    return dot(sum, sum) > 1e-12 ? normalize(sum) : merged_normal(texel_under(position), layer);
}

#endif
