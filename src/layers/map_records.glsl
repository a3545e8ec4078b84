#ifndef PELLUCID_LAYERS_MAP_RECORDS_GLSL
#define PELLUCID_LAYERS_MAP_RECORDS_GLSL

// Filling a map's lists. Needs: layers/map_triangle_setup.glsl.

#include "layers/map_count.glsl"

layout(std430, set = 0, binding = 6) buffer Heads { uint heads[]; };
layout(std430, set = 0, binding = 7) writeonly buffer Records { SurfaceRecord records[]; };

void append_record(MapRecord map, ivec2 texel, uint triangle, uint traits, uint range, uint capacity) {
    uint record = atomicAdd(counts.records, 1u);
    if (record >= capacity) return;  // counted all the same: the host makes more room
    uint next = atomicExchange(heads[map.first_head + uint(texel.y) * map.width + uint(texel.x)], record + 1u);
    records[record] = SurfaceRecord(next, range, triangle, traits);
}

#endif
