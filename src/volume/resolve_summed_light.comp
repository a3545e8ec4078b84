#version 460
// Converts the sums in one placement's voxels (sum_light.glsl) to the images of its light.
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;

#include "volume/light_records.h"
#include "volume/wide_counter.glsl"

layout(set = 0, binding = 0, rgba32f) writeonly uniform image3D light_irradiance;
layout(set = 0, binding = 1, rgba16f) writeonly uniform image3D light_direction;
layout(std430, set = 0, binding = 2) readonly buffer Placements { LightPlacement placements[]; };
layout(std430, set = 0, binding = 3) readonly buffer Sums { uint sums[]; };

layout(push_constant) uniform Push {
    uint own;
    float irradiance_scale;  // W/m2 per unit of a sum
};

void main() {
    LightPlacement placement = placements[own];
    uvec3 at = uvec3(gl_GlobalInvocationID.x, gl_GlobalInvocationID.y % placement.size_y,
                     gl_GlobalInvocationID.y / placement.size_y);
    if (at.x >= placement.size_x || at.z >= placement.size_z) return;
    uint voxel = placement.first_key + at.x + placement.size_x * (at.y + placement.size_y * at.z);
    float units[7];
    for (uint c = 0u; c < 7u; ++c) units[c] = wide_value(sums[14u * voxel + 2u * c], sums[14u * voxel + 2u * c + 1u]);
    // A voxel that gets interpolated light, but contains no point of a patch, gets grey light without a direction.
    vec3 color = vec3(1.0 / 3.0), way = vec3(0.0);
    if (units[1] > 0.0) {
        color = vec3(units[2], units[3], max(units[1] - units[2] - units[3], 0.0)) / units[1];
        way = 2.0 * vec3(units[4], units[5], units[6]) / units[1] - 1.0;
    }
    vec3 irradiance = color * units[0] * irradiance_scale;
    ivec3 texel = ivec3(at) + ivec3(placement.first_x, placement.first_y, placement.first_z);
    imageStore(light_irradiance, texel, vec4(irradiance, units[0] > 0.0 ? 1.0 : 0.0));
    imageStore(light_direction, texel, vec4(way, 0.0));
}
