#version 460
// Lists the pixels of an image that are not empty.
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;

#define PELLUCID_LIST_GROUP 64  // as in pixel_list.glsl, which declares the list for readers

layout(set = 0, binding = 0, r32ui) readonly uniform uimage2DArray marks;
layout(std430, set = 0, binding = 1) buffer PixelList {
    uint list_groups[3];
    uint list_length;
    uint list_pixels[];
};
layout(push_constant) uniform Push {
    uint empty;
    uint first_row;
    uint row_end;
};

void main() {
    uvec2 texel = gl_GlobalInvocationID.xy + uvec2(0u, first_row);
    if (texel.x >= uint(imageSize(marks).x) || texel.y >= row_end) return;
    if (imageLoad(marks, ivec3(texel, 0)).r == empty) return;
    uint i = atomicAdd(list_length, 1u);
    if (i % PELLUCID_LIST_GROUP == 0u) atomicAdd(list_groups[0], 1u);
    list_pixels[i] = texel.x | texel.y << 16;
}
