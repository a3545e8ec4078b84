#version 460
// Lists the pixels of an image that are not empty and want the current sample.
#extension GL_GOOGLE_include_directive : require
#define PELLUCID_MAKES_LISTS_ONLY
#include "layers/pixel_list.glsl"

// A narrow group: some drivers run eight list entries together, and these are then neighbours in both directions.
layout(local_size_x = 4, local_size_y = 16) in;

layout(set = 0, binding = 0, r32ui) readonly uniform uimage2DArray marks;
layout(set = 0, binding = 1, r32ui) readonly uniform uimage2DArray wanted_samples;
PELLUCID_APPENDED_LIST(PixelList, 2, list_groups, list_length, list_pixels, append)
layout(push_constant) uniform Push {
    uint empty;
    uint first_row;
    uint row_end;
    uint sample_index;  // ~0: every pixel wants it
};

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, first_row);
    if (texel.x >= imageSize(marks).x || texel.y >= int(row_end)) return;
    if (sample_index != ~0u && sample_index >= imageLoad(wanted_samples, ivec3(texel, 0)).r) return;
    if (imageLoad(marks, ivec3(texel, 0)).r != empty) append(texel);
}
