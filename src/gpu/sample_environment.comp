#version 460
// Computes the finest level of the environment's pyramid: the mean radiance over each texel.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gpu/structs.h"
#include "gpu/environment.glsl"
#include "gpu/environment_pyramid.glsl"
#include "gpu/octahedral_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint kEnvironmentKind = 0u;

layout(set = 0, binding = 0) uniform texture2D environment_map;
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2DArray pyramid;
layout(push_constant) uniform Push {
    vec4 uniform_radiance;
    EnvironmentPlacement placement;
    uint samples;  // along the side of a texel
};

vec3 radiance_from(vec3 direction) {
    return placed_radiance(kEnvironmentKind, environment_map, uniform_radiance.rgb, placement, direction);
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(kPyramidSize)))) return;
    float fine_size = float(uint(kPyramidSize) * samples);
    vec4 sum = vec4(0.0);
    for (uint y = 0u; y < samples; ++y) {
        for (uint x = 0u; x < samples; ++x) {
            vec2 place = (vec2(uvec2(texel) * samples + uvec2(x, y)) + 0.5) / fine_size;
            vec3 point = octahedron_point(2.0 * place - 1.0);
            float solid_angle = octahedral_texel_solid_angle(point, kPyramidSize);
            sum += solid_angle * vec4(radiance_from(normalize(point)), 1.0);
        }
    }
    imageStore(pyramid, ivec3(texel, 0), vec4(sum.rgb / sum.a, sum.a / float(samples * samples)));
}
