#version 460
#extension GL_GOOGLE_include_directive : require
#include "shade/thin_fragment.glsl"

layout(set = 0, binding = 7) uniform texture2D environment_map;
#include "gpu/diffuse.glsl"
#include "gpu/environment_lookup.glsl"
#include "gpu/light_parts.glsl"

layout(location = 0) out vec4 out_radiance;

void main() {
    MaterialRecord material = materials[material_index];
    vec4 base = base_color(material);
    if (hidden() || base.a < material.alpha_cutoff) discard;
    vec3 view_direction = world_view_direction();
    vec3 normal = facing_normal(view_direction);
    float reflectance = pane_reflectance(normal, view_direction, material.ior);
    vec3 scattered = (1.0 - reflectance) * (1.0 - transmission(material)) * diffuse_radiance(base.rgb, normal);
    vec3 radiance = drawn(PELLUCID_EMITTED, reflectance * environment_radiance(reflect_direction(view_direction, normal))) +
                    drawn(PELLUCID_DIRECT, scattered);
    out_radiance = vec4(min(coverage(material, base) * radiance, vec3(65504.0)), 1.0);  // the target is 16-bit float
}
