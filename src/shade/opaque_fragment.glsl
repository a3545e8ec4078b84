#ifndef PELLUCID_SHADE_OPAQUE_FRAGMENT_GLSL
#define PELLUCID_SHADE_OPAQUE_FRAGMENT_GLSL

// Opaque surfaces under the environment. Needs: kFinishes, see gpu/opaque_surface.glsl.
#extension GL_GOOGLE_include_directive : require
#include "shade/surface_fragment.glsl"
layout(set = 0, binding = 5) uniform texture2D environment_map;
layout(set = 0, binding = 6) uniform texture2D filtered_environment;
layout(std430, set = 0, binding = 22) readonly buffer Appearance { float appearance[]; };
layout(std430, set = 0, binding = 23) readonly buffer Finishes { FinishRecord finishes[]; };
layout(std430, set = 0, binding = 24) readonly buffer Tangents { uint tangents[]; };
#include "gpu/appearance.glsl"
#include "gpu/coverage.glsl"
#include "gpu/opaque_surface.glsl"
#include "layers/corner_weights.glsl"
#include "shade/exact_depth.glsl"

layout(location = 0) out vec4 out_radiance;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_object;
layout(location = 3) out uint out_triangle;

// The fragment as textures of directions see it.
TexturedPoint point_of(ObjectRecord o) {
    TexturedPoint point;
    point.texcoords = texcoords;
    if (!kFinishes) return point;
    uint corner = o.first_corner + 3u * (triangle - o.first_triangle);
    point.v = uvec3(indices[corner], indices[corner + 1u], indices[corner + 2u]);
    vec3 a = (o.world_from_object * vec4(vertex_position(point.v.x), 1.0)).xyz;
    point.edge_b = (o.world_from_object * vec4(vertex_position(point.v.y), 1.0)).xyz - a;
    point.edge_c = (o.world_from_object * vec4(vertex_position(point.v.z), 1.0)).xyz - a;
    Ray ray = camera_ray(gl_FragCoord.xy);
    vec3 origin = (frame.world_from_view * vec4(ray.origin, 1.0)).xyz;
    point.weights = corner_weights(mat3(frame.world_from_view) * ray.direction, a - origin, point.edge_b, point.edge_c);
    return point;
}

void main() {
    MaterialRecord material = materials[material_index];
    uint object = find_object(triangle);
    bool behind;
    float depth = exact_depth(object, behind);
    if (behind && (material.flags & PELLUCID_MATERIAL_SINGLE_SIDED) != 0u) discard;
    vec4 base = base_color(material);
    if (alpha_margin(material, base.a, ivec2(gl_FragCoord.xy) + first_pixel(), triangle, 0u) < 0.0) discard;

    ObjectRecord o = objects[object];
    out_radiance = vec4(opaque_material_radiance(material, base.rgb, point_of(o), o, normalize(world_normal),
                                                 -world_view_direction()), 1.0);
    out_depth = depth;
    out_object = object;
    out_triangle = triangle;
    gl_FragDepth = eye_depth() * frame.depth_scale;
}

#endif
