#ifndef PELLUCID_LAYERS_MAP_RECORDS_GLSL
#define PELLUCID_LAYERS_MAP_RECORDS_GLSL

// Records as the rasteriser finds them, before they are sorted by texel. Needs: layers/map_triangle_setup.glsl.
#include "layers/map_count.glsl"

layout(std430, set = 0, binding = 6) buffer Texels { TexelRecords texels[]; };
layout(std430, set = 0, binding = 7) writeonly buffer Found { uvec4 found[]; };  // texel, number there, triangle, range

void append_record(MapRecord map, ivec2 texel, uint triangle, uint range, uint capacity) {
    uint index = map.first_head + uint(texel_order(map, texel));
    uint number = atomicAdd(texels[index].count, 1u);
    uint i = atomicAdd(counts.records, 1u);  // counted even if there is no room: the host then makes more
    if (i < capacity) found[i] = uvec4(index, number, triangle, range);
}

#endif
