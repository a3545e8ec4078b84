#version 460
// Counts the pixels with glass by the status of their paths.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r32ui) readonly uniform uimage2DArray path_events;
layout(std430, set = 0, binding = 1) buffer EventCounts {
    uint conflicts;  // disagreements of shading and geometric normals about the side
    uint statuses[7];
};

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID.xy, 0);
    if (any(greaterThanEqual(at.xy, imageSize(path_events).xy))) return;
    uint events = imageLoad(path_events, at).r;  // see unpack_events() in techniques/technique.h
    if ((events & 0xfffu) == 0u) return;
    atomicAdd(statuses[min(events >> 24 & 0xfu, 6u)], 1u);
    if ((events >> 28 & 1u) != 0u) atomicAdd(conflicts, 1u);
}
