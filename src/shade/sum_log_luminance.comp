#version 460
// One sum of log luminance per tile of the image, for the log-average (adapt_luminance.comp).
#extension GL_GOOGLE_include_directive : require
#define PELLUCID_ADDS_UP
#include "shade/adaptation.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 0, rgba32f) readonly uniform image2DArray radiance;
layout(std430, set = 0, binding = 1) writeonly buffer TileSums { float tile_sums[]; };
layout(push_constant) uniform Push {
    float unit_cd_m2;
    int side;        // pixels per invocation along each axis
    uint first_sum;  // index of the first sum of this part of the image
};

void main() {
    ivec2 size = imageSize(radiance).xy, first = side * ivec2(gl_GlobalInvocationID.xy);
    float sum = 0.0;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            ivec2 at = first + ivec2(x, y);
            if (any(greaterThanEqual(at, size))) continue;
            sum += log(luminance_cd_m2(imageLoad(radiance, ivec3(at, 0)).rgb, unit_cd_m2) + kDarkest);
        }
    }
    sum = sum_of_group(sum);
    if (gl_LocalInvocationIndex == 0u) tile_sums[first_sum + gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = sum;
}
