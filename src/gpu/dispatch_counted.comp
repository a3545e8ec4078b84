#version 460
// Computes the number of workgroups of 64 for the items of a counted buffer (counted_buffer.h).
layout(local_size_x = 1) in;
layout(std430, set = 0, binding = 0) readonly buffer Counted { uint count; };
layout(std430, set = 0, binding = 1) writeonly buffer Groups { uint groups[3]; };
layout(push_constant) uniform Push {
    uint capacity;
    uint row;  // workgroups that fit in a row of a dispatch
};

void main() {
    uint needed = (min(count, capacity) + 63u) / 64u;
    uint rows = needed / row + 1u;
    groups[0] = (needed + rows - 1u) / rows;
    groups[1] = rows;
    groups[2] = 1u;
}
