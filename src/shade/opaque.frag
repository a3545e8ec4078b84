#version 460
#extension GL_GOOGLE_include_directive : require
#include "shade/surface_fragment.glsl"
layout(set = 0, binding = 5) uniform texture2D environment_map;
layout(set = 0, binding = 6) uniform texture2D filtered_environment;
#include "gpu/opaque_surface.glsl"
#include "shade/exact_depth.glsl"

layout(location = 0) out vec4 out_radiance;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_object;
layout(location = 3) out uint out_triangle;

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
    out_triangle = triangle;
    gl_FragDepth = eye_depth() * frame.depth_scale;
}
