#version 460
// Lists the pixels whose centres lie in texels of a surface map that have records.
#extension GL_GOOGLE_include_directive : require
#define PELLUCID_MAKES_LISTS_ONLY
#include "layers/pixel_list.glsl"
#include "layers/surface_map.glsl"

layout(local_size_x = 4, local_size_y = 16) in;  // as in list_pixels.comp

layout(std430, set = 0, binding = 0) readonly buffer Texels { TexelRecords texels[]; };
layout(std430, set = 0, binding = 2) readonly buffer Maps { MapRecord maps[]; };
PELLUCID_APPENDED_LIST(PixelList, 1, list_groups, list_length, list_pixels, append)
layout(push_constant) uniform Push {
    uint width, height;
    float texels_per_pixel;
};

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(width) || pixel.y >= int(height)) return;
    ivec2 texel = ivec2((vec2(pixel) + 0.5) * texels_per_pixel);
    if (texels[texel_order(maps[0], texel)].count != 0u) append(pixel);
}
