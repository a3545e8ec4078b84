#ifndef PELLUCID_LAYERS_MAP_COUNT_GLSL
#define PELLUCID_LAYERS_MAP_COUNT_GLSL

// Twin of MapCount in surface_map.cpp. The first three words are the arguments of the tiles' dispatch.
struct MapCount {
    uint tile_groups, tile_rows, tile_layers;
    uint tiles;
    uint records;
};

layout(std430, set = 0, binding = 5) buffer MapCounters { MapCount counts; };

#endif
