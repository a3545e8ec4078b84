#version 460
// From the power in the texels of all receivers to their irradiance, in both halves (land_light.comp).
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

layout(local_size_x = 8, local_size_y = 8) in;

#include "volume/light_records.h"

layout(std430, set = 0, binding = 0) readonly buffer Receivers { LightReceiver receivers[]; };
layout(std430, set = 0, binding = 1) readonly buffer Texels { uint64_t texels[]; };
layout(std430, set = 0, binding = 2) writeonly buffer ReceiverLight { vec4 receiver_light[]; };

layout(push_constant) uniform Push {
    uint own;
    float power_scale;
};

void main() {
    LightReceiver receiver = receivers[own];
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= uint(receiver.side.w) || at.y >= uint(receiver.up.w)) return;
    uint texel = floatBitsToUint(receiver.normal.w) + at.x + uint(receiver.side.w) * at.y;
    float scale = 1.0 / (power_scale * receiver.corner.w * receiver.corner.w);
    for (uint half_ = 0u; half_ < 2u; ++half_, texel += uint(texels.length()) / 6u)
        receiver_light[texel] = vec4(float(texels[3u * texel]) * scale, float(texels[3u * texel + 1u]) * scale,
                                     float(texels[3u * texel + 2u]) * scale, 1.0);
}
