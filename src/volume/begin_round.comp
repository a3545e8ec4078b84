#version 460
// Runs between two rounds. The patches written become those to read, and their number sets the workgroup counts.
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 1) in;

#include "volume/volume_record.glsl"
#include "volume/light_patch.glsl"

layout(std430, set = 0, binding = 0) buffer State { LightState state; };
layout(std430, set = 0, binding = 1) writeonly buffer StepGroups { uint step_groups[3]; };
layout(std430, set = 0, binding = 2) writeonly buffer LandGroups { uint land_groups[3]; };

const uint kGroup = 64u;  // of step_light and land_light

void main() {
    // Extra patches could use the capacity that the patches of the previous round left.
    uint room = capacity - min(capacity, state.in_kept + state.in_extra);
    state.in_kept = min(state.kept, capacity);
    state.in_extra = min(state.extra, room);
    uint count = state.in_kept + state.in_extra;
    state.left = count;
    state.peak = max(state.peak, count);
    state.rounds += count > 0u ? 1u : 0u;
    state.landing = state.landed;
    state.kept = 0u;
    state.extra = 0u;
    state.landed = 0u;
    step_groups[0] = (count + kGroup - 1u) / kGroup;
    step_groups[1] = 1u;
    step_groups[2] = 1u;
    land_groups[0] = (state.landing + kGroup - 1u) / kGroup;
    land_groups[1] = 1u;
    land_groups[2] = 1u;
}
