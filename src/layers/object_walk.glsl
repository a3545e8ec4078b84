#ifndef PELLUCID_LAYERS_OBJECT_WALK_GLSL
#define PELLUCID_LAYERS_OBJECT_WALK_GLSL

// The nearest surface that a ray meets in the maps of all meshes (mesh_maps.h). Each map is in its mesh's own frame.
//
// The ray visits objects in the order of the scene. It walks the maps of an object whose box it meets nearer than the
// nearest hit so far. The cost is a box test per object plus a walk per box that the ray passes.
//
// Needs: frame, objects (ObjectRecord[]), traits (per object), and everything that surface_walk.glsl needs. can_meet()
// gets triangle indices over all objects.
#include "layers/surface_walk.glsl"

// Twin of MappedObject in mesh_maps.cpp.
struct MappedObject {
    vec3 low;
    uint first_map;       // of the mesh's three maps, one per axis
    vec3 high;            // box of the maps, in the mesh's frame
    uint first_triangle;  // of the mesh, over all meshes
};
layout(std430, set = 0, binding = 26) readonly buffer MappedObjects { MappedObject mapped_objects[]; };

// The nearest surface beyond `t_min`, m.
SurfaceHit find_surface_among_objects(vec3 origin, vec3 direction, float t_min, inout Search search) {
    SurfaceHit nearest = kNoHit;
    for (uint i = 0u; i < frame.object_count; ++i) {
        MappedObject mapped = mapped_objects[i];
        // The direction is not normalised, so that distances are those in world space.
        mat3 object_from_world = transpose(mat3(objects[i].world_from_object_normal));
        vec3 from = object_from_world * (origin - objects[i].world_from_object[3].xyz);
        vec3 way = object_from_world * direction;
        float near = t_min, far = min(nearest.t, search.limit);
        for (int k = 0; k < 3; ++k) {
            clip(from[k] - mapped.low[k], way[k], near, far);
            clip(mapped.high[k] - from[k], -way[k], near, far);
        }
        if (near > far) continue;
        search.object_traits = traits[i];
        search.first_triangle = objects[i].first_triangle - mapped.first_triangle;
        // All maps of a mesh have the same texel width, so the ray passes the fewest texels along the nearest axis.
        vec3 along = abs(way);
        uint axis = along.x > along.y ? (along.x > along.z ? 0u : 2u) : (along.y > along.z ? 1u : 2u);
        float t_end;
        SurfaceHit hit = find_surface(maps[mapped.first_map + axis], from, way, t_min, search, t_end);
        // A mirroring transform reverses both the winding and the outward normals of triangles, so `leaving` holds.
        if (hit.t < nearest.t) nearest = hit;
    }
    search.object_traits = search.first_triangle = 0u;
    return nearest;
}

#endif
