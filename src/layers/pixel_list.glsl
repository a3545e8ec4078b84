#ifndef PELLUCID_LAYERS_PIXEL_LIST_GLSL
#define PELLUCID_LAYERS_PIXEL_LIST_GLSL

// A list of pixels that a dispatch of one invocation each goes through; made by list_pixels.comp. Its first words
// are the arguments of that dispatch. Includers have `layout(local_size_x = PELLUCID_LIST_GROUP) in;`.
#define PELLUCID_LIST_GROUP 64

layout(std430, set = 0, binding = 19) readonly buffer PixelList {
    uint list_groups[3];
    uint list_length;
    uint list_pixels[];  // x | y << 16
};

// False: there is no pixel for this invocation.
bool listed_pixel(out ivec2 texel) {
    uint i = gl_GlobalInvocationID.x;
    if (i >= list_length) return false;
    texel = ivec2(list_pixels[i] & 0xffffu, list_pixels[i] >> 16);
    return true;
}

#endif
