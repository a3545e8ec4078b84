#version 460
#extension GL_GOOGLE_include_directive : require
#include "shade/surface_fragment.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
layout(set = 0, binding = 5) uniform texture2D environment_map;
layout(set = 0, binding = 6) uniform texture2D filtered_environment;
#include "gpu/opaque_surface.glsl"
#include "layers/objects.glsl"
#include "gpu/vertices.glsl"

layout(location = 0) out vec4 out_radiance;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_object;

// Depth of the triangle along the view ray, and whether it is seen from behind. What the rasteriser interpolates is too
// coarse to say whether glass a hair's breadth before it is seen.
float exact_depth(uint object, out bool behind) {
    ObjectRecord o = objects[object];
    uint corner = o.first_corner + 3u * (triangle - o.first_triangle);
    vec3 v[3];
    for (uint k = 0u; k < 3u; ++k)
        v[k] = (frame.view_from_world * (o.world_from_object * vec4(vertex_position(indices[corner + k]), 1.0))).xyz;
    vec3 normal = cross(v[1] - v[0], v[2] - v[0]);
    Ray ray = camera_ray(gl_FragCoord.xy);
    float along = dot(normal, ray.direction);
    behind = (along > 0.0) != (o.mirrored != 0u);
    float depth = -(ray.origin + dot(normal, v[0] - ray.origin) / along * ray.direction).z;
    vec3 depths = -vec3(v[0].z, v[1].z, v[2].z);
    float low = min(depths.x, min(depths.y, depths.z)), high = max(depths.x, max(depths.y, depths.z));
    return depth >= low && depth <= high ? depth : clamp(eye_depth(), low, high);  // edge-on, it has no one depth
}

void main() {
    MaterialRecord material = materials[material_index];
    uint object = find_object(triangle);
    bool behind;
    float depth = exact_depth(object, behind);
    if (behind && (material.flags & PELLUCID_MATERIAL_SINGLE_SIDED) != 0u) discard;
    vec4 base = base_color(material);
    if (base.a < material.alpha_cutoff) discard;

    vec3 view_direction = world_view_direction();
    out_radiance = vec4(opaque_material_radiance(material, base.rgb, texcoords.xy, texcoords.zw,
                                                 facing_normal(view_direction), -view_direction), 1.0);
    out_depth = depth;
    out_object = object;
    gl_FragDepth = eye_depth() * frame.depth_scale;
}
