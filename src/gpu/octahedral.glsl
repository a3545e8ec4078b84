#ifndef PELLUCID_GPU_OCTAHEDRAL_GLSL
#define PELLUCID_GPU_OCTAHEDRAL_GLSL

// Unit vectors in 32 bits: Cigolle et al., "A Survey of Efficient Representations for Independent
// Unit Vectors", JCGT 2014, section 3.3 (octahedral, 2 x 16 bit; error below 0.004 degrees).

vec2 sign_not_zero(vec2 v) {
    return vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0);
}

// Position of a direction in the square -1..1. n may have any length but 0.
vec2 octahedral_from_direction(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    return n.z < 0.0 ? (1.0 - abs(p.yx)) * sign_not_zero(p) : p;
}

// The point of the octahedron abs(x) + abs(y) + abs(z) = 1 at a position in the square; not of unit length.
vec3 octahedron_point(vec2 p) {
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * sign_not_zero(n.xy);
    return n;
}

uint pack_direction(vec3 n) {
    return packSnorm2x16(octahedral_from_direction(n));
}

vec3 unpack_unit_vector(uint packed) {
    return normalize(octahedron_point(unpackSnorm2x16(packed)));
}

#endif
