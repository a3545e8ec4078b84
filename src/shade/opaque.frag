#version 460
#extension GL_GOOGLE_include_directive : require
#include "shade/surface_fragment.glsl"
#include "gpu/diffuse.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
#include "layers/objects.glsl"

layout(location = 0) out vec4 out_radiance;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_object;

void main() {
    MaterialRecord material = materials[material_index];
    vec4 base = base_color(material);
    if (base.a < material.alpha_cutoff) discard;

    vec3 radiance = base.rgb;
    if ((material.flags & PELLUCID_MATERIAL_UNLIT) == 0u) {
        vec3 emission = material.emission.rgb * sample_texture(material.emission_texture, texcoords.xy, texcoords.zw).rgb;
        radiance = diffuse_radiance(base.rgb, facing_normal(world_view_direction())) + emission;
    }
    out_radiance = vec4(radiance, 1.0);
    out_depth = eye_depth();
    out_object = find_object(triangle);
    gl_FragDepth = out_depth * frame.depth_scale;
}
