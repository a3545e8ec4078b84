#ifndef PELLUCID_LAYERS_MAP_RECORDS_GLSL
#define PELLUCID_LAYERS_MAP_RECORDS_GLSL

// Records from the rasteriser, before they are sorted by texel. Needs: layers/map_triangle_setup.glsl.
layout(std430, set = 0, binding = 6) buffer Texels { TexelRecords texels[]; };
layout(std430, set = 0, binding = 7) buffer Found {
    uint found_count, found_reserved[3];
    uvec4 found[];  // texel, number within the texel, triangle, range
};

// Writes a record at index `place` of the list. If the triangle does not cover the texel, the record gets kNoTexel.
// Places beyond the capacity are dropped but counted, so the host enlarges the list.
void put_record(MapRecord map, uint place, ivec2 texel, uint triangle, uint range, bool covered) {
    uint index = kNoTexel, number = 0u;
    if (covered) {
        index = map.first_head + uint(texel_order(map, texel));
        number = atomicAdd(texels[index].count, 1u);
    }
    if (place < found.length()) found[place] = uvec4(index, number, triangle, range);
}

#endif
