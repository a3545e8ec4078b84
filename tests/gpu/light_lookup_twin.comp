#version 460
// Looks up traced light as a renderer does, for comparison with what is known.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform texture3D light_irradiance;
layout(set = 0, binding = 1) uniform texture3D light_direction;
#include "volume/volume_record.glsl"
#include "volume/light_records.h"
layout(std430, set = 0, binding = 2) readonly buffer Volumes { VolumeRecord volumes[]; };
layout(std430, set = 0, binding = 3) readonly buffer Placements { LightPlacement placements[]; };
layout(std430, set = 0, binding = 4) readonly buffer Receivers { LightReceiver receivers[]; };
layout(std430, set = 0, binding = 5) readonly buffer ReceiverLight { vec4 receiver_light[]; };
#include "volume/light_lookup.glsl"

struct Case {
    vec4 position;  // world
    vec4 way;       // unit, world; w: length of the straight way
    vec4 medium;    // scattering per voxel, and g
};
struct Answer {
    vec4 scattered;  // w: 1 where the straight way is clear
    vec4 received;   // w: 1 on a receiver
};
layout(std430, set = 0, binding = 6) readonly buffer Cases { Case cases[]; };
layout(std430, set = 0, binding = 7) writeonly buffer Answers { Answer answers[]; };

layout(push_constant) uniform Push {
    uint volume_count;
    uint receiver_count;
};

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= cases.length()) return;
    Case own = cases[i];
    VolumeRecord volume = volumes[0];
    vec3 x = (volume.voxel_from_world * vec4(own.position.xyz, 1.0)).xyz;
    vec3 way = mat3(volume.voxel_from_world) * own.way.xyz * volume.voxel;
    bool clear = straight_way_is_clear(volume_count, own.position.xyz, own.way.xyz, own.way.w);
    vec3 irradiance;
    vec3 without_volumes;
    bool received = receiver_irradiance(receiver_count, own.position.xyz, irradiance, without_volumes);
    answers[i].scattered = vec4(scattered_radiance(0u, x, way, own.medium), clear ? 1.0 : 0.0);
    answers[i].received = vec4(irradiance, received ? 1.0 : 0.0);
}
