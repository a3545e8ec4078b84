#version 460
// Tabulates irradiance / pi of the environment for surfaces of every normal.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gpu/structs.h"
#include "gpu/environment_pyramid.glsl"
#include "gpu/filter_levels.glsl"
#include "gpu/octahedral_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform texture2D pyramid;
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2DArray filtered_environment;

const int kLevel = 2;  // level of the pyramid: 128 x 128 texels of mean radiance, 1.4 degrees wide

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(kIrradianceTableSize)))) return;
    vec3 normal = normalize(octahedron_point((2.0 * vec2(texel) + 1.0) / float(kIrradianceTableSize) - 1.0));
    int size = pyramid_size(kLevel);
    ivec2 corner = pyramid_corner(kLevel);
    vec4 sum = vec4(0.0);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            vec3 point = octahedron_point((2.0 * vec2(x, y) + 1.0) / float(size) - 1.0);
            float weight = max(dot(normal, normalize(point)), 0.0) * octahedral_texel_solid_angle(point, size);
            sum += weight * vec4(texelFetch(pyramid, corner + ivec2(x, y), 0).rgb, 1.0);
        }
    }
    imageStore(filtered_environment, ivec3(kIrradianceTableCorner + texel, 0), vec4(sum.rgb / sum.a, 1.0));
}
