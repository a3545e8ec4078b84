#version 460
// Lists the texels of a surface map that have records.
#extension GL_GOOGLE_include_directive : require
#define PELLUCID_MAKES_LISTS_ONLY
#include "layers/pixel_list.glsl"
#include "layers/surface_map.glsl"

layout(local_size_x = 4, local_size_y = 16) in;  // as in list_pixels.comp

layout(std430, set = 0, binding = 0) readonly buffer Texels { TexelRecords texels[]; };
layout(std430, set = 0, binding = 2) readonly buffer Maps { MapRecord maps[]; };
PELLUCID_APPENDED_LIST(PixelList, 1, list_groups, list_length, list_pixels, append)
layout(push_constant) uniform Push { uint width, height, texel_side; };

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    MapRecord map = maps[0];
    if (texel.x >= int(width) || texel.y >= int(height)) return;
    if (texels[texel_order(map, texel / int(texel_side))].count != 0u) append(texel);
}
