#ifndef PELLUCID_LIGHT_IRRADIANCE_LOOKUP_GLSL
#define PELLUCID_LIGHT_IRRADIANCE_LOOKUP_GLSL

// Irradiance from the cache.
#include "light/irradiance_cells.glsl"

layout(std430, set = 0, binding = 55) readonly buffer IrradianceNodes { IrradianceGrid irradiance_grid; IrradianceNode irradiance_nodes[]; };

const float kEnoughSamples = 4.0;  // of the last frame; below, coarser nodes make up the number

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

// rgb: sum of the samples of a level around a position, in units, trilinear between nodes; a: their number.
vec4 samples_around(vec3 position, vec3 normal, int level) {
    vec3 at = position * exp2(float(-level)), low = floor(at), weight = at - low;
    vec4 sum = vec4(0.0);
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
            sum += share * own.x * own.y * own.z * vec4(units, node.count);
        }
    }
    return sum;
}

// W/m2, of other surfaces' light. False: nothing is known of the position. `choice`, 0..1: between levels.
bool cached_irradiance(vec3 position, vec3 normal, float choice, out vec3 irradiance) {
    int level = int(floor(irradiance_level(irradiance_grid, position) + choice));
    vec4 samples = samples_around(position, normal, level);
    float enough = kEnoughSamples * float(irradiance_grid.weight);
    if (samples.a < enough) {
        vec4 coarse = samples_around(position, normal, level + kCoarserLevels);
        if (coarse.a > 0.0) samples += (enough - samples.a) * coarse / coarse.a;
    }
    irradiance = samples.a > 0.0 ? irradiance_grid.unit * samples.rgb / samples.a : vec3(0.0);
    return samples.a > 0.0;
}

#endif
