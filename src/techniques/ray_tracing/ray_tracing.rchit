#version 460
// Where the ray met the surface, from the triangle's corners: closer to its plane than the ray's own
// point at that distance.
#extension GL_GOOGLE_include_directive : require
#include "gpu/structs.h"
#include "techniques/ray_tracing/surface_hit.glsl"

layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };

struct Vertex {
    float x, y, z;
    float normal_x, normal_y, normal_z;
};
layout(std430, buffer_reference, buffer_reference_align = 4) readonly buffer Vertices { Vertex at[]; };
layout(std430, buffer_reference, buffer_reference_align = 4) readonly buffer Indices { uint at[]; };

layout(location = 0) rayPayloadInEXT SurfaceHit hit;
hitAttributeEXT vec2 barycentrics;

void main() {
    ObjectRecord object = objects[gl_InstanceCustomIndexEXT];
    vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    uint first = object.first_corner + 3u * uint(gl_PrimitiveID);
    mat3 positions, normals;
    for (uint corner = 0u; corner < 3u; ++corner) {
        Vertex v = Vertices(vertices).at[Indices(indices).at[first + corner]];
        positions[corner] = vec3(v.x, v.y, v.z);
        normals[corner] = vec3(v.normal_x, v.normal_y, v.normal_z);
    }
    mat3 world_normal = mat3(object.world_from_object_normal);
    hit.position = (object.world_from_object * vec4(positions * weights, 1.0)).xyz;
    hit.object = uint(gl_InstanceCustomIndexEXT);
    hit.normal = normalize(world_normal * (normals * weights));
    hit.geometric_normal = world_normal * cross(positions[1] - positions[0], positions[2] - positions[0]);
}
