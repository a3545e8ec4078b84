#version 460
// What the textures of the first glass surface multiply its base colour and its transmission with.
#extension GL_GOOGLE_include_directive : require
#include "shade/surface_fragment.glsl"
#include "layers/layers.glsl"

layout(set = 0, binding = 5, r32ui) readonly uniform uimage2DArray layer_triangle;

layout(location = 0) out vec4 out_tint;

void main() {
    uint first = imageLoad(layer_triangle, ivec3(gl_FragCoord.xy, 0)).r;
    if (triangle_index(first) != triangle) discard;
    MaterialRecord material = materials[material_index];
    out_tint = vec4(vertex_color.rgb * sample_texture(material.base_color_texture, texcoords.xy, texcoords.zw).rgb,
                    sample_texture(material.transmission_texture, texcoords.xy, texcoords.zw).r);
}
