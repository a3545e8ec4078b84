#ifndef PELLUCID_TECHNIQUES_WANG_2014_MERGED_LAYERS_GLSL
#define PELLUCID_TECHNIQUES_WANG_2014_MERGED_LAYERS_GLSL

// Reads the searched layer, as written by merge_layers.comp: depths and normals at a pixel coordinate. Needs:
// technique_bindings.glsl, fault_size.

layout(set = 0, binding = 10, r32f) readonly uniform image2DArray merged_depth;
layout(std430, set = 0, binding = 13) readonly buffer EntryLimit { uint farthest_entry; };  // depth, as bits
layout(set = 0, binding = 11, r32ui) readonly uniform uimage2DArray merged_normal;  // world, octahedral

float texel_depth(ivec2 texel, uint of_layer) { return imageLoad(merged_depth, ivec3(texel, of_layer)).r; }

ivec2 texel_at(vec2 pixel) { return clamp(ivec2(pixel), ivec2(0), ivec2(frame.width, frame.height) - 1); }

float stored_depth(vec2 pixel, uint of_layer) { return texel_depth(texel_at(pixel), of_layer); }

// The four texels around a pixel coordinate with bilinear weights (low x first, then low y), and their weighted depth.
// Texels across a fault zone from the nearest texel show another surface and have weight 0.
struct Footprint {
    ivec2 low, high;
    vec4 weights;
    float depth;
};

Footprint footprint(vec2 pixel, uint of_layer) {
    ivec2 last = ivec2(frame.width, frame.height) - 1;
    vec2 point = clamp(pixel - 0.5, vec2(0.0), vec2(last));
    ivec2 low = clamp(ivec2(point), ivec2(0), last), high = min(low + 1, last);
    vec2 share = point - vec2(low), rest = 1.0 - share;

    vec4 depths = vec4(texel_depth(low, of_layer), texel_depth(ivec2(high.x, low.y), of_layer),
                       texel_depth(ivec2(low.x, high.y), of_layer), texel_depth(high, of_layer));
    vec2 nearest_row = share.y < 0.5 ? depths.xy : depths.zw;
    float nearest = share.x < 0.5 ? nearest_row.x : nearest_row.y;
    vec4 weights = vec4(rest.x, share.x, rest.x, share.x) * vec4(rest.yy, share.yy);
    weights *= vec4(lessThanEqual(abs(depths - nearest), vec4(fault_size)));
    weights /= dot(weights, vec4(1.0));
    return Footprint(low, high, weights, dot(weights, depths));
}

vec3 texel_normal(ivec2 texel, uint of_layer) {
    return unpack_unit_vector(imageLoad(merged_normal, ivec3(texel, of_layer)).r);
}

// Interpolated unit normal in world space.
vec3 normal_at(vec2 pixel, uint of_layer) {
    Footprint around = footprint(pixel, of_layer);
    vec3 sum = around.weights.x * texel_normal(around.low, of_layer) +
               around.weights.y * texel_normal(ivec2(around.high.x, around.low.y), of_layer) +
               around.weights.z * texel_normal(ivec2(around.low.x, around.high.y), of_layer) +
               around.weights.w * texel_normal(around.high, of_layer);
    // If opposite normals cancel out, use one of them.
    return dot(sum, sum) > 1e-12 ? normalize(sum) : texel_normal(around.low, of_layer);
}

#endif
