#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_MICROFACETS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_MICROFACETS_GLSL

// Random choices of a path, and the facets of rough glass: Heitz, "Sampling the GGX distribution of visible normals",
// JCGT 2018. Needs: frame, seed (of the sample and pixel).

uint seed;

// Jarzynski & Olano, "Hash functions for GPU rendering", JCGT 2020: pcg3d.
uvec3 hash(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// 0 to below 1; every event of every sample has its own, so that choices along a path do not depend on each other.
vec2 random_numbers(uint event) {
    return vec2(hash(uvec3(seed, event, 2u * frame.sample_index)).xy >> 8u) / 16777216.0;
}
float random_number(uint event) {
    return float(hash(uvec3(seed, event, 2u * frame.sample_index + 1u)).z >> 8u) / 16777216.0;
}

// A facet's normal that is visible from where the path comes from, on the side of `n`; what other facets hide of the
// light that it sends on is taken from the path.
vec3 sampled_normal(vec3 n, inout Path path, float roughness) {
    float alpha = max(roughness * roughness, 1e-4);
    vec3 across = normalize(abs(n.z) < 0.9 ? cross(n, vec3(0.0, 0.0, 1.0)) : cross(n, vec3(1.0, 0.0, 0.0)));
    vec3 along = cross(n, across);
    vec3 wo = -vec3(dot(path.direction, across), dot(path.direction, along), dot(path.direction, n));
    if (wo.z <= 0.0) return n;
    vec2 u = random_numbers(path.events);
    vec3 stretched = normalize(vec3(alpha * wo.xy, wo.z));
    float squared = dot(stretched.xy, stretched.xy);
    vec3 t1 = squared > 0.0 ? vec3(-stretched.y, stretched.x, 0.0) * inversesqrt(squared) : vec3(1.0, 0.0, 0.0);
    vec3 t2 = cross(stretched, t1);
    float radius = sqrt(u.x), angle = 6.283185307 * u.y, share = 0.5 * (1.0 + stretched.z);
    float x = radius * cos(angle), y = radius * sin(angle);
    y = (1.0 - share) * sqrt(max(1.0 - x * x, 0.0)) + share * y;
    vec3 m = x * t1 + y * t2 + sqrt(max(1.0 - x * x - y * y, 0.0)) * stretched;
    m = normalize(vec3(alpha * m.xy, max(m.z, 1e-6)));
    return normalize(m.x * across + m.y * along + m.z * n);
}

#endif
