#ifndef PELLUCID_VOLUME_OPAQUE_TREE_GLSL
#define PELLUCID_VOLUME_OPAQUE_TREE_GLSL

// Intersection of rays with opaque surfaces (opaque_tree.h). Needs: volume/light_records.h; buffers OpaqueNodes {
// OpaqueNode opaque_nodes[]; } and OpaqueTriangles { OpaqueTriangle opaque_triangles[]; }; uint opaque_count.

struct OpaqueHit {
    float t;      // in units of the direction; 1e30: no hit
    vec3 normal;  // of the triangle, not of unit length
    uint object;
};
const OpaqueHit kNoOpaqueHit = OpaqueHit(1e30, vec3(0.0), 0u);

bool meets_node(OpaqueNode node, vec3 position, vec3 inverse, float from, float to) {
    vec3 a = (node.low.xyz - position) * inverse, b = (node.high.xyz - position) * inverse;
    vec3 near = min(a, b), far = max(a, b);
    return max(max(near.x, near.y), max(near.z, from)) <= min(min(far.x, far.y), min(far.z, to));
}

// Intersects a triangle (Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997). Replaces `hit`
// if the triangle is nearer.
void meet_triangle(OpaqueTriangle triangle, vec3 position, vec3 direction, float from, inout OpaqueHit hit) {
    const float kEdge = 1e-5;  // relative overlap of triangles, so that no light passes between them
    vec3 p = cross(direction, triangle.edge_c.xyz), apart = position - triangle.corner.xyz;
    float determinant_ = dot(triangle.edge_b.xyz, p);
    if (determinant_ == 0.0) return;
    float u = dot(apart, p) / determinant_;
    vec3 q = cross(apart, triangle.edge_b.xyz);
    float v = dot(direction, q) / determinant_, t = dot(triangle.edge_c.xyz, q) / determinant_;
    if (u < -kEdge || v < -kEdge || u + v > 1.0 + kEdge || t < from || t >= hit.t) return;
    hit = OpaqueHit(t, cross(triangle.edge_b.xyz, triangle.edge_c.xyz), floatBitsToUint(triangle.corner.w));
}

// The first surface with `from` <= t <= `to`, in units of `direction`.
OpaqueHit first_opaque(vec3 position, vec3 direction, float from, float to) {
    OpaqueHit hit = kNoOpaqueHit;
    hit.t = to;
    vec3 steps = mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    vec3 inverse = 1.0 / steps;
    bool met = false;
    for (uint i = 0u; i < opaque_count;) {
        OpaqueNode node = opaque_nodes[i];
        if (!meets_node(node, position, inverse, from, hit.t)) {
            i = floatBitsToUint(node.low.w);
            continue;
        }
        uint leaf = floatBitsToUint(node.high.w);
        for (uint k = 0u; k < (leaf & 7u); ++k) {
            float before = hit.t;
            meet_triangle(opaque_triangles[(leaf >> 3u) + k], position, direction, from, hit);
            met = met || hit.t < before;
        }
        ++i;
    }
    if (!met) return kNoOpaqueHit;
    return hit;
}

#endif
