#version 460
// Converts the keys (brightest_light.glsl) of one placement's voxels to the images of its light.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

layout(local_size_x = 8, local_size_y = 8) in;

#include "gpu/octahedral.glsl"
#include "volume/light_records.h"
#include "volume/light_key.glsl"

layout(set = 0, binding = 0, rgba32f) writeonly uniform image3D light_irradiance;
layout(set = 0, binding = 1, rgba16f) writeonly uniform image3D light_direction;
layout(std430, set = 0, binding = 2) readonly buffer Placements { LightPlacement placements[]; };
layout(std430, set = 0, binding = 3) readonly buffer Keys { uint64_t keys[]; };

layout(push_constant) uniform Push { uint own; };

void main() {
    LightPlacement placement = placements[own];
    uvec3 at = uvec3(gl_GlobalInvocationID.x, gl_GlobalInvocationID.y % placement.size_y,
                     gl_GlobalInvocationID.y / placement.size_y);
    if (at.x >= placement.size_x || at.z >= placement.size_z) return;
    uvec3 size = uvec3(placement.size_x, placement.size_y, placement.size_z);
    uint own_key = placement.first_key + at.x + size.x * (at.y + size.y * at.z);
    uint64_t key = keys[own_key];
    vec3 irradiance = key_irradiance(key), way = key == 0ul ? vec3(0.0) : key_direction(key);
    // The centres of patches may miss a voxel between lit ones. Such a voxel gets the mean of its lit neighbours.
    if (key == 0ul) {
        uint strides[3] = uint[](1u, size.x, size.x * size.y);
        float count = 0.0;
        for (int k = 0; k < 3; ++k) {
            if (at[k] == 0u || at[k] + 1u == size[k]) continue;
            uint64_t before = keys[own_key - strides[k]], after = keys[own_key + strides[k]];
            if (before == 0ul || after == 0ul) continue;
            irradiance += key_irradiance(before) + key_irradiance(after);
            way += key_direction(before) + key_direction(after);
            count += 2.0;
        }
        irradiance /= max(count, 1.0);
        way /= max(length(way), 1e-6);
    }
    ivec3 texel = ivec3(at) + ivec3(placement.first_x, placement.first_y, placement.first_z);
    imageStore(light_irradiance, texel, vec4(irradiance, dot(way, way) > 0.0 ? 1.0 : 0.0));
    imageStore(light_direction, texel, vec4(way, 0.0));
}
