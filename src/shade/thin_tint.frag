#version 460
#extension GL_GOOGLE_include_directive : require
#include "shade/thin_fragment.glsl"

layout(location = 0) out vec4 out_tint;

void main() {
    MaterialRecord material = materials[material_index];
    vec4 base = base_color(material);
    if (hidden() || base.a < material.alpha_cutoff) discard;
    vec3 view_direction = world_view_direction();
    float reflectance = pane_reflectance(facing_normal(view_direction), view_direction, material.ior);
    out_tint = vec4(mix(vec3(1.0), base.rgb * transmission(material) * (1.0 - reflectance), coverage(material, base)), 1.0);
}
