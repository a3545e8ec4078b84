#ifndef PELLUCID_LAYERS_MAP_TRIANGLE_SETUP_GLSL
#define PELLUCID_LAYERS_MAP_TRIANGLE_SETUP_GLSL

// A triangle in a map: the texels that it covers, and its depths there. No clipping is needed (Olano & Greer, "Triangle
// scan conversion using 2D homogeneous coordinates", 1997).
#include "layers/surface_map.glsl"

const float kTexelMargin = 0.01;  // texels; exceeds the rounding of a walk (surface_walk.glsl)

struct MapCoverage {
    ivec2 low, high;      // texels; empty where high < low
    vec2 base;            // texel at which the equations have their origin, for precision
    vec3 edges[3];        // inside where all (x, y, 1) . edge >= 0
    vec3 depth;           // q = (x, y, 1) . depth
    vec2 depth_range;     // of the whole triangle
    bool speck;           // far smaller than a texel: rounding hides its plane, and depth_range suffices
};

// `p`: corners in map space, before the division by W.
MapCoverage cover(MapRecord map, vec4 p[3]) {
    MapCoverage c;
    c.low = ivec2(1);
    c.high = ivec2(0);
    vec3 low = vec3(1e30), high = vec3(-1e30);
    for (int i = 0; i < 3; ++i) {
        vec4 from = p[i], to = p[(i + 1) % 3];
        if (from.w >= map.near_w) {
            vec3 at = from.xyz / from.w;
            low = min(low, at);
            high = max(high, at);
        }
        if ((from.w < map.near_w) != (to.w < map.near_w)) {
            vec4 cut = mix(from, to, (map.near_w - from.w) / (to.w - from.w));
            vec3 at = cut.xyz / map.near_w;
            low = min(low, at);
            high = max(high, at);
        }
    }
    vec2 size = vec2(map.width, map.height);
    if (any(greaterThan(low, high)) || any(greaterThan(low.xy, size)) || any(lessThan(high.xy, vec2(0.0))) || low.z > 1.0 ||
        high.z < 0.0) {
        return c;
    }
    c.low = ivec2(clamp(floor(low.xy - kTexelMargin), vec2(0.0), size - 1.0));
    c.high = ivec2(clamp(floor(high.xy + kTexelMargin), vec2(0.0), size - 1.0));
    c.depth_range = vec2(low.z, high.z);
    c.speck = max(high.x - low.x, high.y - low.y) < 0.25;
    c.base = vec2(c.low);
    vec3 q[3];
    for (int i = 0; i < 3; ++i) q[i] = vec3(p[i].xy - c.base * p[i].w, p[i].w);
    for (int i = 0; i < 3; ++i) c.edges[i] = cross(q[(i + 1) % 3], q[(i + 2) % 3]);
    float area = dot(q[0], c.edges[0]);
    c.depth = (p[0].z * c.edges[0] + p[1].z * c.edges[1] + p[2].z * c.edges[2]) / area;
    if (area < 0.0) {
        for (int i = 0; i < 3; ++i) c.edges[i] = -c.edges[i];
    }
    return c;
}

// Whether the triangle covers any part of a texel.
bool covers(MapCoverage c, ivec2 texel) {
    vec3 center = vec3(vec2(texel) + 0.5 - c.base, 1.0);
    bool inside = true;
    for (int i = 0; i < 3; ++i) {
        float reach = (0.5 + kTexelMargin) * (abs(c.edges[i].x) + abs(c.edges[i].y));
        inside = inside && dot(c.edges[i], center) + reach >= 0.0;
    }
    return inside;
}

// Depths of the triangle's plane over the texel, clamped to the depth range of the triangle.
uint depths_in_texel(MapCoverage c, ivec2 texel) {
    if (c.speck) return pack_range(c.depth_range.x, c.depth_range.y);
    float middle = dot(c.depth, vec3(vec2(texel) + 0.5 - c.base, 1.0));
    float reach = (0.5 + kTexelMargin) * (abs(c.depth.x) + abs(c.depth.y));
    vec2 range = vec2(middle - reach, middle + reach);
    if (!(range.x <= range.y)) range = c.depth_range;  // edge-on, or NaN
    range = vec2(max(range.x, c.depth_range.x), min(range.y, c.depth_range.y));
    if (!(range.x <= range.y)) range = c.depth_range;
    return pack_range(range.x, range.y);
}

#endif
