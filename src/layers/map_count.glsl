#ifndef PELLUCID_LAYERS_MAP_COUNT_GLSL
#define PELLUCID_LAYERS_MAP_COUNT_GLSL

// Twin of MapCount in surface_map.cpp.
struct MapCount {
    uint tiles;
    uint records;
    uint placed;
};

layout(std430, set = 0, binding = 5) buffer MapCounters { MapCount counts; };

#endif
