#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_CROSS_SURFACE_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_CROSS_SURFACE_GLSL

// What a path does at a surface. Needs: path_state.glsl, gpu/vertices.glsl, objects, materials, solids, find_object().
#include "gpu/object_traits.glsl"

// A point of a triangle, in the world.
struct Surface {
    vec3 position;
    vec3 normal;      // unit, interpolated, outward
    vec3 geometric;   // of the triangle itself, outward, any length
};

Surface surface_at(uint triangle, uint object, vec3 origin, vec3 direction) {
    ObjectRecord o = objects[object];
    uint corner = o.first_corner + 3u * (triangle - o.first_triangle);
    uvec3 v = uvec3(indices[corner], indices[corner + 1u], indices[corner + 2u]);
    vec3 a = (o.world_from_object * vec4(vertex_position(v.x), 1.0)).xyz;
    vec3 edge_b = (o.world_from_object * vec4(vertex_position(v.y), 1.0)).xyz - a;
    vec3 edge_c = (o.world_from_object * vec4(vertex_position(v.z), 1.0)).xyz - a;
    vec3 weights = corner_weights(direction, a - origin, edge_b, edge_c);
    vec3 normal = mat3(o.world_from_object_normal) * (weights.x * vertex_normal(v.x) + weights.y * vertex_normal(v.y) +
                                                      weights.z * vertex_normal(v.z));
    vec3 geometric = cross(edge_b, edge_c) * (o.mirrored != 0u ? -1.0 : 1.0);
    return Surface(a + weights.y * edge_b + weights.z * edge_c,
                   normalize(dot(normal, normal) > 1e-30 ? normal : geometric), geometric);
}

MaterialRecord filling_material(uint rank) { return materials[solids[rank]]; }
float filling_ior(uint rank) { return rank == kAir ? 1.0 : filling_material(rank).ior; }

// Refracts the path, or reflects it totally.
void bend(inout Path path, vec3 outward, bool leaving, float n_i, float n_t) {
    vec3 n = leaving ? -outward : outward;
    float eta = n_i / n_t;
    float cos_theta_i = -dot(path.direction, n);
    path.side_conflict = path.side_conflict || cos_theta_i < 0.0;
    ++path.events;
    vec3 incident = path.direction;
    if (refract_direction(incident, n, eta, path.direction)) path.transmittance *= 1.0 - fresnel_dielectric(cos_theta_i, eta);
    else ++path.reflections;  // refract_direction has left the reflected direction
}

// Crosses the boundary of a solid on which the path now stands. The interpolated normal can send it to the other
// side of the triangle than it means to: it is where it goes.
void cross_surface(inout Path path, Surface surface, uint traits, bool leaving) {
    uint rank = rank_of(traits), count = entered(rank);
    uint before = filling_rank();
    bool closed = (traits & kClosed) != 0u;
    if (!closed) set_entered(rank, leaving ? 1u : 0u);
    before = filling_rank();
    uint around = entered(rank);
    set_entered(rank, leaving ? max(around, 1u) - 1u : around + 1u);
    uint beyond = filling_rank();
    if (beyond == before) return;
    bend(path, surface.normal, leaving, filling_ior(before), filling_ior(beyond));
    bool left = dot(path.direction, surface.geometric) > 0.0;
    if (left != leaving) set_entered(rank, around);  // reflected
}

#endif
