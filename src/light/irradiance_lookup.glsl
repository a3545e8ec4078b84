#ifndef PELLUCID_LIGHT_IRRADIANCE_LOOKUP_GLSL
#define PELLUCID_LIGHT_IRRADIANCE_LOOKUP_GLSL

// Look-ups of irradiance in the cache.
#include "light/irradiance_cells.glsl"

layout(std430, set = 0, binding = 55) readonly buffer IrradianceNodes { IrradianceGrid irradiance_grid; IrradianceNode irradiance_nodes[]; };

const float kEnoughSamples = 4.0;  // at the weight of the last frame; coarser nodes supply missing samples

uint find_node(uvec2 node) {
    for (uint i = 0u; i < kMostProbes; ++i) {
        uint slot = (node.x + i) & irradiance_grid.slot_mask, key = irradiance_nodes[slot].key;
        if (key == node.y) return slot;
        if (key == 0u) return kNoNode;
    }
    return kNoNode;
}

float signed_units(uvec2 sum) {
    bool negative = int(sum.y) < 0;
    if (negative) {
        sum.x = ~sum.x + 1u;
        sum.y = ~sum.y + (sum.x == 0u ? 1u : 0u);
    }
    float size = float(sum.y) * 4294967296.0 + float(sum.x);
    return negative ? -size : size;
}

// Sums of the nodes of a level around a position, interpolated trilinearly.
struct NodeSums {
    vec4 samples;  // rgb: sum of irradiance, in units; a: sum of weights
    vec2 open;     // sums of cosines: unoccluded directions, all directions
};

NodeSums sums_around(vec3 position, vec3 normal, int level) {
    vec3 at = position * exp2(float(-level)), low = floor(at), weight = at - low;
    NodeSums sum = NodeSums(vec4(0.0), vec2(0.0));
    for (uint axis = 0u; axis < 3u; ++axis) {
        float share = normal[axis] * normal[axis];
        if (share < 0.01) continue;
        uint facing = axis + (normal[axis] < 0.0 ? 3u : 0u);
        for (uint corner = 0u; corner < 8u; ++corner) {
            ivec3 step_ = ivec3(corner & 1u, corner >> 1u & 1u, corner >> 2u);
            vec3 own = mix(1.0 - weight, weight, vec3(step_));
            uint slot = find_node(node_hash(ivec3(low) + step_, level, facing));
            if (slot == kNoNode) continue;
            IrradianceNode node = irradiance_nodes[slot];
            vec3 units = vec3(signed_units(node.sums[0]), signed_units(node.sums[1]), signed_units(node.sums[2]));
            float counts = share * own.x * own.y * own.z;
            sum.samples += counts * vec4(units, node.count);
            sum.open += counts * vec2(signed_units(node.sums[3]), signed_units(node.sums[4]));
        }
    }
    return sum;
}

// Light at a position from the cache.
struct CachedLight {
    bool known;
    vec3 irradiance;  // W/m2, from other surfaces
    float open;       // unoccluded share of the environment's light on the surface, 0..1
};

const CachedLight kNoCachedLight = CachedLight(false, vec3(0.0), 1.0);

// `choice`: random number, 0..1, that selects one of two levels.
CachedLight cached_light(vec3 position, vec3 normal, float choice) {
    int level = int(floor(irradiance_level(irradiance_grid, position) + choice));
    NodeSums sums = sums_around(position, normal, level);
    float enough = kEnoughSamples * float(irradiance_grid.weight);
    if (sums.samples.a < enough) {
        NodeSums coarse = sums_around(position, normal, level + kCoarserLevels);
        float share = coarse.samples.a > 0.0 ? (enough - sums.samples.a) / coarse.samples.a : 0.0;
        sums.samples += share * coarse.samples;
        sums.open += share * coarse.open;
    }
    CachedLight light = kNoCachedLight;
    light.known = sums.samples.a > 0.0;
    if (light.known) light.irradiance = irradiance_grid.unit * sums.samples.rgb / sums.samples.a;
    if (sums.open.y > 0.0) light.open = clamp(sums.open.x / sums.open.y, 0.0, 1.0);
    return light;
}

#endif
