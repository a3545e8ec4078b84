#ifndef PELLUCID_LAYERS_SURFACE_WALK_GLSL
#define PELLUCID_LAYERS_SURFACE_WALK_GLSL

// Finds the nearest surface that a ray meets. The ray walks over the texels that it passes in a surface map.
//
// A line in space is a line in the map, so the ray is a + s (b - a) there, s = 0..1. The third coordinate is the depth
// q. If the ray passes none of the depth ranges of a pyramid node, the walk skips the node and climbs. Otherwise it
// descends. In a texel the walk intersects the triangles of all records whose ranges the ray passes.
//
// Needs: maps, map_triangles, texels, ranges, records, pyramid (surface_map.glsl), kCrossing, struct Search
// (path_walk.glsl), and bool can_meet(Search search, uint traits, bool leaving, uint triangle). can_meet() decides
// whether the ray may meet a surface in that direction.
#include "layers/surface_map.glsl"
#include "gpu/object_traits.glsl"

const float kNudge = 0.002;      // texels past the edge of a node; less than kTexelMargin
const float kSlack = 1e-4;       // of barycentric weights, so that a ray through an edge meets a triangle there
const float kFarthest = 1e30;
// Limits for the nodes and records that a ray visits in one pass. The software driver silently ends all loops of an
// invocation after 65,535 iterations. Eight invocations run together, and each counts the iterations of all.
const uint kMostTurns = 65535u, kTogether = 8u, kTurnsPerVisit = 2u;
const uint kMostVisits = 8000u;

struct MapRay {
    vec3 a, way;          // map space: the start, and the vector b - a to the end
    float t_a, t_b;       // distances along the ray in space at a and b
    float w_a, w_b;       // W at a and b
    bool to_far;          // the ray ends at the far side of the map, behind all surfaces
};

struct SurfaceHit {
    float t;         // kFarthest: none
    uint triangle;
    uint traits;
    bool leaving;    // the ray goes along the outward normal
};

const SurfaceHit kNoHit = SurfaceHit(kFarthest, PELLUCID_NO_TRIANGLE, 0u, false);

// At equal distances the lower triangle index wins, because the order of records is random.
bool is_nearer(SurfaceHit a, SurfaceHit b) { return a.t < b.t || (a.t == b.t && a.triangle < b.triangle); }

void take_nearer(inout SurfaceHit hit, SurfaceHit candidate) {
    if (is_nearer(candidate, hit)) hit = candidate;
}

// The point where the line of a ray meets the plane of a triangle.
struct TriangleHit {
    float t;
    vec3 weights;  // of the corners; none is negative inside the triangle
    bool leaving;
};

TriangleHit intersect_triangle(uint triangle, vec3 origin, vec3 direction) {
    int at = 3 * int(triangle);
    vec4 a = uintBitsToFloat(texelFetch(map_triangles, at)), b = uintBitsToFloat(texelFetch(map_triangles, at + 1)),
         c = uintBitsToFloat(texelFetch(map_triangles, at + 2));
    vec3 p = cross(direction, c.xyz), from_corner = origin - a.xyz, q = cross(from_corner, b.xyz);
    float determinant = dot(b.xyz, p);  // minus the speed along the outward normal
    vec2 weights = vec2(dot(from_corner, p), dot(direction, q)) / determinant;
    return TriangleHit(dot(c.xyz, q) / determinant, vec3(1.0 - weights.x - weights.y, weights), determinant < 0.0);
}

// Clips [t_low, t_high] to the t with start + t rate >= 0.
void clip(float start, float rate, inout float t_low, inout float t_high) {
    float t = -start / rate;
    if (rate > 0.0) t_low = max(t_low, t);
    if (rate < 0.0) t_high = min(t_high, t);
    if (rate == 0.0 && start < 0.0) t_high = -1.0;
}

// Clips a ray to the map, up to the distance `limit`, m. False if the ray does not enter the map.
bool map_ray(MapRecord map, vec3 origin, vec3 direction, float limit, out MapRay ray) {
    vec4 p = map.map_from_space * vec4(origin, 1.0), r = map.map_from_space * vec4(direction, 0.0);
    float low = 0.0, high = limit;
    clip(p.w - map.near_w, r.w, low, high);
    clip(p.x, r.x, low, high);
    clip(p.y, r.y, low, high);
    clip(p.z, r.z, low, high);
    vec3 size = vec3(map.width, map.height, 1.0);
    clip(size.x * p.w - p.x, size.x * r.w - r.x, low, high);
    clip(size.y * p.w - p.y, size.y * r.w - r.y, low, high);
    float sides = high;
    clip(p.w - p.z, r.w - r.z, low, high);
    vec4 a = p + low * r, b = p + high * r;
    ray = MapRay(a.xyz / a.w, b.xyz / b.w - a.xyz / a.w, low, high, a.w, b.w, high < sides);
    return low < high && high < kFarthest;
}

float distance_at(MapRay ray, float s) {
    float share = s * ray.w_a;
    return mix(ray.t_a, ray.t_b, share / (share + (1.0 - s) * ray.w_b));
}

// The parameter s of the point at distance t.
float way_at(MapRay ray, float t) {
    float share = (t - ray.t_a) / (ray.t_b - ray.t_a);
    return share * ray.w_b / (share * ray.w_b + (1.0 - share) * ray.w_a);
}

// The nearest surface beyond `t_min`, m. `t_end`: distance at which the ray leaves the map; kFarthest at its far side.
// Counts the nodes and records visited. A search that exceeds the limit gives up.
SurfaceHit find_surface(MapRecord map, vec3 origin, vec3 direction, float t_min, inout Search search, out float t_end) {
    SurfaceHit hit = kNoHit;
    MapRay ray;
    bool in_map = map_ray(map, origin, direction, search.limit, ray);
    t_end = !in_map ? 0.0 : ray.to_far ? kFarthest : ray.t_b;
    if (!in_map) return hit;
    vec2 inverse = 1.0 / mix(ray.way.xy, vec2(1e-9), lessThan(abs(ray.way.xy), vec2(1e-9)));
    ivec2 ahead = -ivec2(greaterThan(inverse, vec2(0.0)));
    float nudge = kNudge * min(abs(inverse.x), abs(inverse.y));
    int top = int(map_levels(map)) - 1, level = 0;
    vec2 last_texel = vec2(map.width, map.height) - 1.0;
    float s = 0.0;
    ivec2 texel = ivec2(clamp(ray.a.xy, vec2(0.0), last_texel));
    int order = texel_order(map, texel);
    while (s < 1.0 && search.visits < search.most_visits) {
        int low, high;
        float s_out;
        bool at_leaf = false;
        while (s < 1.0 && !at_leaf && search.visits < search.most_visits) {
            ++search.visits;
            int side = 1 << level;
            vec2 to_edge = (vec2((texel & -side) + (ahead & side)) - ray.a.xy) * inverse;
            s_out = min(min(to_edge.x, to_edge.y) + nudge, 1.0);
            s_out = min(max(s_out, s + 0.5 * nudge), 1.0);  // along the map's axis a ray crosses no edge
            float q_in = ray.a.z + s * ray.way.z, q_out = ray.a.z + s_out * ray.way.z;
            low = int(min(q_in, q_out) * kDepthSteps - 1.0);
            high = int(max(q_in, q_out) * kDepthSteps + 2.0);
            ivec4 ranges = ivec4(texelFetch(pyramid, node_index(map, level, order)));
            bool passes = any(lessThanEqual(max(ranges & 0xffff, ivec4(low)), min((ranges >> 16) & 0xffff, ivec4(high))));
            if (!passes) {
                s = s_out;
                texel = ivec2(clamp(ray.a.xy + s * ray.way.xy, vec2(0.0), last_texel));
                int next = texel_order(map, texel);
                if (level < top && (next ^ order) >> 2 * level > 3) ++level;
                order = next;
            } else if (level > 0) {
                --level;
            } else {
                at_leaf = true;
            }
        }
        if (!at_leaf) break;
        float t_max = distance_at(ray, min(s_out + nudge, 1.0));
        t_max += 1e-5 * abs(t_max);
        uvec2 own = texelFetch(texels, int(map.first_head) + order).xy;
        uint block = own.x / kRangeBlock, end = (own.x + own.y + kRangeBlock - 1u) / kRangeBlock;
        search.visits += own.y;
        if (search.visits > search.most_visits) break;
        uint passed = 0u;  // records of a block whose ranges the ray passes, a bit each
        for (;;) {
            while (passed == 0u && block < end) {
                ivec4 depths = ivec4(texelFetch(ranges, int(block++)));
                bvec4 passes = lessThanEqual(max(depths & 0xffff, ivec4(low)), min((depths >> 16) & 0xffff, ivec4(high)));
                passed = uint(passes.x) | uint(passes.y) << 1 | uint(passes.z) << 2 | uint(passes.w) << 3;
            }
            if (passed == 0u) break;
            uvec2 record = texelFetch(records, int(block * kRangeBlock - kRangeBlock) + findLSB(passed)).xy;
            passed &= passed - 1u;
            uint triangle = record.x + search.first_triangle, own_traits = record.y + search.object_traits;
            TriangleHit at = intersect_triangle(record.x, origin, direction);
            float least = min(at.weights.x, min(at.weights.y, at.weights.z));
            // A shell that crosses itself counts its crossings, so a ray must not meet it twice at an edge.
            bool inside = least >= (kCrossing && (own_traits & kCrossesItself) != 0u ? 0.0 : -kSlack);
            if (inside && at.t > t_min && at.t <= t_max && can_meet(search, own_traits, at.leaving, triangle))
                take_nearer(hit, SurfaceHit(at.t, triangle, own_traits, at.leaving));
        }
        if (hit.t < kFarthest) break;
        s = s_out;
        texel = ivec2(clamp(ray.a.xy + s * ray.way.xy, vec2(0.0), last_texel));
        order = texel_order(map, texel);
    }
    search.gave_up = search.gave_up || (hit.t == kFarthest && search.visits >= search.most_visits);
    return hit;
}

#endif
