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
#include "light/photons.glsl"
struct PhotonReceiver {
    bool none;
};
vec3 photon_reflection(Photon photon, PhotonReceiver receiver) { return vec3(1.0); }
#include "light/photon_lookup.glsl"
#include "volume/light_lookup.glsl"

struct Case {
    vec4 position;  // world
    vec4 way;       // unit, world; of scattered light, and normal of a surface
    vec4 medium;    // scattering per voxel, and g
};
struct Answer {
    vec4 scattered, received;
};
layout(std430, set = 0, binding = 6) readonly buffer Cases { Case cases[]; };
layout(std430, set = 0, binding = 7) writeonly buffer Answers { Answer answers[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= cases.length()) return;
    Case own = cases[i];
    VolumeRecord volume = volumes[0];
    vec3 x = (volume.voxel_from_world * vec4(own.position.xyz, 1.0)).xyz;
    vec3 way = mat3(volume.voxel_from_world) * own.way.xyz * volume.voxel;
    answers[i].scattered = vec4(scattered_radiance(0u, x, way, own.medium), 0.0);
    answers[i].received = vec4(photon_light(own.position.xyz, own.way.xyz, PhotonReceiver(true)), 0.0);
}
