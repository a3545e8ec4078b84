#ifndef PELLUCID_LAYERS_TRACE_SURFACE_GLSL
#define PELLUCID_LAYERS_TRACE_SURFACE_GLSL

// Finds the nearest surface that a ray meets with the device's ray tracing (VK_KHR_ray_query).
//
// The device reports the triangles on the ray. Each is intersected with the arithmetic of the other finders, so every
// finder leads to the same path.
//
// Needs: everything that layers/surface_walk.glsl needs, objects, traits (per object), kManySlots.
#include "layers/surface_walk.glsl"

layout(std430, set = 0, binding = 38) readonly buffer ShellTraits { uint shell_traits[]; };  // per triangle of meshes
layout(set = 0, binding = 46) uniform accelerationStructureEXT hierarchy;  // of all objects, by custom index

// The nearest surface beyond `t_min`, m. Distances of the device and of intersect_triangle() differ by less than
// `slack`, m.
SurfaceHit trace_surface(vec3 origin, vec3 direction, float t_min, float slack, Search search) {
    SurfaceHit hit = kNoHit;
    float start = t_min - slack;  // a ray query allows no negative distance
    rayQueryEXT query;
    rayQueryInitializeEXT(query, hierarchy, gl_RayFlagsNoneEXT, 0xffu, origin + start * direction, 0.0, direction,
                          min(search.limit - start + slack, kFarthest));
    while (rayQueryProceedEXT(query)) {
        uint object = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false));
        uint number = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false));  // in the mesh
        uint triangle = objects[object].first_triangle + number, own_traits = traits[object];
        if (kManySlots) own_traits += shell_traits[objects[object].first_corner / 3u + number];
        TriangleHit at = intersect_triangle(triangle, origin, direction);
        if (at.t > t_min && at.t <= search.limit && can_meet(search, own_traits, at.leaving, triangle))
            take_nearer(hit, SurfaceHit(at.t, triangle, own_traits, at.leaving));
        // A confirmed triangle ends the query at its distance. The nearest is not confirmed, because a triangle that
        // the device sees slightly farther away may be nearer by intersect_triangle().
        if (start + rayQueryGetIntersectionTEXT(query, false) > hit.t + slack) rayQueryConfirmIntersectionEXT(query);
    }
    return hit;
}

#endif
