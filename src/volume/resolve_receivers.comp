#version 460
// From the power in the texels of all receivers to their irradiance, in both halves (land_light.comp).
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;

#include "volume/light_records.h"
#include "volume/wide_counter.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Receivers { LightReceiver receivers[]; };
layout(std430, set = 0, binding = 1) readonly buffer Texels { uint texels[]; };
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
    for (uint half_ = 0u; half_ < 2u; ++half_, texel += uint(texels.length()) / 12u) {
        vec3 power;
        for (uint c = 0u; c < 3u; ++c) power[c] = wide_value(texels[6u * texel + 2u * c], texels[6u * texel + 2u * c + 1u]);
        receiver_light[texel] = vec4(power * scale, 1.0);
    }
}
