#ifndef PELLUCID_LAYERS_PIXEL_LIST_GLSL
#define PELLUCID_LAYERS_PIXEL_LIST_GLSL

// Lists of pixels (pixel_list.h): the arguments of a dispatch, the number of pixels, and the pixels as x | y << 16. The
// dispatch has one invocation per pixel, in workgroups of PELLUCID_LIST_GROUP. Vulkan guarantees only 65,535 workgroups
// in a row. So the dispatch has as many rows as the longest possible list needs.
#define PELLUCID_LIST_GROUP 64

uint list_word(ivec2 texel) { return uint(texel.x) | uint(texel.y) << 16; }

// The list that a shader with `layout(local_size_x = PELLUCID_LIST_GROUP) in;` processes.
#ifndef PELLUCID_MAKES_LISTS_ONLY
layout(std430, set = 0, binding = 19) readonly buffer PixelList {
    uint list_groups[3];
    uint list_length;
    uint list_pixels[];
};

// The pixel of this invocation. False if the list has none for it.
bool listed_pixel(out ivec2 texel) {
    uint group = gl_WorkGroupID.x * list_groups[1] + gl_WorkGroupID.y;
    uint i = group * PELLUCID_LIST_GROUP + gl_LocalInvocationID.x;
    if (i >= list_length) return false;
    texel = ivec2(list_pixels[i] & 0xffffu, list_pixels[i] >> 16);
    return true;
}
#endif

// Declares a list that start_list.comp has begun, and a function that appends a pixel to it.
#define PELLUCID_APPENDED_LIST(Block, block_binding, groups, length_, pixels, append) \
    layout(std430, set = 0, binding = block_binding) buffer Block {                   \
        uint groups[3];                                                               \
        uint length_;                                                                 \
        uint pixels[];                                                                \
    };                                                                                \
    void append(ivec2 texel) {                                                        \
        uint i = atomicAdd(length_, 1u);                                              \
        if (i % (PELLUCID_LIST_GROUP * groups[1]) == 0u) atomicAdd(groups[0], 1u);    \
        pixels[i] = list_word(texel);                                                 \
    }

#endif
