#version 460
// Runs rays through the volumes of a scene, for comparison with the C++ side.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform texture3D volume_index;
layout(set = 0, binding = 4) uniform texture3D volume_bricks;
layout(constant_id = 0) const bool kCubic = false;
#define PELLUCID_CUBIC_INDEX kCubic
#include "volume/volume_field.glsl"
#include "optics/eikonal.glsl"
#include "optics/phase.glsl"

layout(std430, set = 0, binding = 1) readonly buffer Volumes { VolumeRecord volumes[]; };
struct Case {
    vec4 position;   // voxels; w: step
    vec4 direction;  // w: steps
};
struct Answer {
    vec4 field;
    vec4 x[6];  // Euler and RK4 in steps of space, then of time; leapfrog and Nystrom
    vec4 v[6];  // w: Henyey-Greenstein with the direction's x as cosine and its y as g
};
layout(std430, set = 0, binding = 2) readonly buffer Cases { Case cases[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Answers { Answer answers[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= cases.length()) return;
    Case own = cases[i];
    enter_volume(volumes[0], 0u);
    vec4 field = index_field(own.position.xyz);
    answers[i].field = field;
    CurvedRay rays[6];
    for (int k = 0; k < 6; ++k) rays[k] = CurvedRay(own.position.xyz, field.w * own.direction.xyz);
    float h = own.position.w;
    for (float step = 0.0; step < own.direction.w; step += 1.0) {
        rays[0] = euler_space_step(rays[0], h);
        rays[1] = rk4_space_step(rays[1], h);
        rays[2] = euler_time_step(rays[2], h);
        rays[3] = rk4_time_step(rays[3], h);
        rays[4] = leapfrog_step(rays[4], h);
        rays[5] = nystrom_step(rays[5], h);
    }
    for (int k = 0; k < 6; ++k) {
        answers[i].x[k] = vec4(rays[k].x, 0.0);
        answers[i].v[k] = vec4(rays[k].v, henyey_greenstein(own.direction.x, own.direction.y));
    }
}
