#version 460
// Starts an empty list of pixels; see pixel_list.glsl.
layout(local_size_x = 1) in;

layout(std430, set = 0, binding = 0) writeonly buffer PixelList {
    uint list_groups[3];
    uint list_length;
};
layout(push_constant) uniform Push { uint rows; };  // of workgroups

void main() {
    list_groups[0] = 0u;
    list_groups[1] = rows;
    list_groups[2] = 1u;
    list_length = 0u;
}
