#version 460
// Counts the power of the patches that remain when the rounds end.
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 64) in;

#include "volume/volume_record.glsl"
#include "volume/light_patch.glsl"

layout(std430, set = 0, binding = 0) buffer State { LightState state; };
#include "volume/light_power.glsl"
layout(std430, set = 0, binding = 1) readonly buffer PatchesIn { LightPatch patches_in[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= state.in_kept + state.in_extra) return;
    Quad quad = unpack_patch(patches_in[i < state.in_kept ? i : capacity - 1u - (i - state.in_kept)]);
    end_patch(quad, PELLUCID_LIGHT_LEFT);
}
