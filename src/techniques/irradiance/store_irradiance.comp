#version 460
// Adds a frame's samples of irradiance to the nodes of the cache. Sums are integers, so their order does not matter.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
#include "gpu/octahedral.glsl"
#include "light/irradiance_cells.glsl"
#include "light/irradiance_points.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 1, rgba32f) readonly uniform image2DArray path_radiance;
// openness to the environment, from gather()
layout(set = 0, binding = 2, rgba32f) readonly uniform image2DArray reflected_radiance;
layout(std430, set = 0, binding = 55) buffer IrradianceNodes { IrradianceGrid irradiance_grid; IrradianceNode irradiance_nodes[]; };

const float kMostUnits = 1.0e12;  // bound on a sample; a sum can take 2^23 weighted samples

// Returns the node's slot, or a new slot for a new node. kNoNode: all possible slots are occupied.
uint claim_node(uvec2 node) {
    for (uint i = 0u; i < kMostProbes; ++i) {
        uint slot = (node.x + i) & irradiance_grid.slot_mask;
        uint before = atomicCompSwap(irradiance_nodes[slot].key, 0u, node.y);
        if (before == 0u || before == node.y) return slot;
    }
    return kNoNode;
}

// Adds an integer to a 64-bit sum, whose two words are updated separately.
void add_to_sum(uint slot, uint channel, float units) {
    float size = min(abs(units), kMostUnits) * float(irradiance_grid.weight);
    uint high = uint(size / 4294967296.0), low = uint(size - float(high) * 4294967296.0);
    if (units < 0.0) {
        low = ~low + 1u;
        high = ~high + (low == 0u ? 1u : 0u);
    }
    uint before = atomicAdd(irradiance_nodes[slot].sums[channel].x, low);
    uint carry = before + low < before ? 1u : 0u;
    if (high + carry != 0u) atomicAdd(irradiance_nodes[slot].sums[channel].y, high + carry);
}

void store(vec3 position, int level, uint facing, vec3 dither, vec3 units, vec2 cosines) {
    ivec3 node = ivec3(floor(position * exp2(float(-level)) + dither));
    uint slot = claim_node(node_hash(node, level, facing));
    if (slot == kNoNode) {
        atomicAdd(irradiance_grid.lost, 1u);
        return;
    }
    atomicAdd(irradiance_nodes[slot].count, irradiance_grid.weight);
    for (uint c = 0u; c < 3u; ++c) add_to_sum(slot, c, units[c]);
    for (uint k = 0u; k < 2u; ++k)
        if (cosines[k] > 0.0) add_to_sum(slot, 3u + k, cosines[k]);
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= int(frame.width) || texel.y >= int(frame.height)) return;
    IrradiancePoint point = points[uint(texel.y) * frame.width + uint(texel.x)];
    if (point.normal == kNoIrradiance) return;
    vec3 units = imageLoad(path_radiance, ivec3(texel, 0)).rgb / irradiance_grid.unit;
    vec3 normal = unpack_unit_vector(point.normal);
    uvec3 bits = hash(uvec3(texel, 3u * frame.sample_index)), more = hash(uvec3(texel, 3u * frame.sample_index + 1u));
    vec3 u = vec3(bits >> 8u) / 16777216.0;
    vec2 v = vec2(more.xy >> 8u) / 16777216.0;
    // Choose an axis with probabilities given by the squares of the normal's components.
    float choice = v.x, x2 = normal.x * normal.x, y2 = normal.y * normal.y;
    uint axis = choice < x2 ? 0u : choice < x2 + y2 ? 1u : 2u, facing = axis + (normal[axis] < 0.0 ? 3u : 0u);
    int level = int(floor(irradiance_level(irradiance_grid, point.position) + v.y));
    vec4 sky = imageLoad(reflected_radiance, ivec3(texel, 0));
    vec2 cosines = round(kCosineUnits * sky.a * vec2(clamp(sky.g, 0.0, 1.0), 1.0));
    store(point.position, level, facing, u, units, cosines);
    store(point.position, level + kCoarserLevels, facing, u, units, cosines);
}
