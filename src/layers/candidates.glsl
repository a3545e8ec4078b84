#ifndef PELLUCID_LAYERS_CANDIDATES_GLSL
#define PELLUCID_LAYERS_CANDIDATES_GLSL

// The nearest surface that a ray meets among the candidates that the host has found for its path (host_finder.h).
// The arithmetic is that of layers/surface_walk.glsl.
//
// Needs: everything that layers/surface_walk.glsl needs.
#include "layers/surface_walk.glsl"

layout(set = 0, binding = 44) uniform utextureBuffer candidate_lists;  // per path: index of its first candidate, count
layout(set = 0, binding = 45) uniform utextureBuffer candidates;       // triangle, traits

// The nearest candidate beyond `t_min`, m.
SurfaceHit find_candidate(vec3 origin, vec3 direction, float t_min, Search search) {
    uvec2 own = texelFetch(candidate_lists, int(search.pixel)).xy;
    SurfaceHit hit = kNoHit;
    for (uint k = 0u; k < own.y; ++k) {
        uvec2 candidate = texelFetch(candidates, int(own.x + k)).xy;
        TriangleHit at = intersect_triangle(candidate.x, origin, direction);
        if (at.t > t_min && at.t <= search.limit && can_meet(search, candidate.y, at.leaving, candidate.x))
            take_nearer(hit, SurfaceHit(at.t, candidate.x, candidate.y, at.leaving));
    }
    return hit;
}

#endif
