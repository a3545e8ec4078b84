#version 460
// Emits the patches of one front towards the box of its volume. Light towards the box of an earlier volume is left to
// that volume's own front. Patches begin at the light; those of a directional light begin in front of all volumes.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

layout(local_size_x = 8, local_size_y = 8) in;

#include "volume/volume_record.glsl"
#include "volume/light_patch.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Volumes { VolumeRecord volumes[]; };
layout(std430, set = 0, binding = 1) readonly buffer Fronts { LightFront fronts[]; };
layout(std430, set = 0, binding = 2) buffer State { LightState state; };
#include "volume/light_power.glsl"
layout(std430, set = 0, binding = 3) writeonly buffer PatchesOut { LightPatch patches_out[]; };

const int kRays = 4;  // rays along a side of a patch
const uint kDirectionalLight = 0u, kSpotLight = 2u;  // pellucid::Light::Kind

void main() {
    LightFront own = fronts[front];
    uvec2 cell = gl_GlobalInvocationID.xy;
    if (cell.x >= uint(own.corner.w) || cell.y >= uint(own.side.w)) return;
    bool directional = uint(own.direction.w) == kDirectionalLight;
    Quad quad;
    const vec2 kCorners[4] = vec2[](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1));
    for (int k = 0; k < 4; ++k) {
        vec2 at = vec2(cell) + kCorners[k];
        vec3 place = own.corner.xyz + at.x * own.side.xyz + at.y * own.up.xyz;
        quad.v[k] = directional ? own.direction.xyz : normalize(place);
        quad.x[k] = directional ? place : own.position.xyz + own.position.w * quad.v[k];
    }
    vec2 at = vec2(cell) + 0.5;
    vec3 place = own.corner.xyz + at.x * own.side.xyz + at.y * own.up.xyz;
    vec3 way = directional ? own.direction.xyz : normalize(place);
    // Estimate the part of the patch that heads for the box by rays. Where fronts meet, their patches share the power.
    uint wanted = floatBitsToUint(own.cone.z);
    float part = 0.0;
    for (int ray = 0; ray < kRays * kRays; ++ray) {
        vec2 in_cell = vec2(cell) + (vec2(ray % kRays, ray / kRays) + 0.5) / float(kRays);
        vec3 ray_place = own.corner.xyz + in_cell.x * own.side.xyz + in_cell.y * own.up.xyz;
        vec3 ray_way = directional ? own.direction.xyz : normalize(ray_place);
        vec3 ray_start = directional ? ray_place : own.position.xyz;
        bool heads_there = box_distance(volumes[wanted], ray_start, ray_way) < 1e30;
        for (uint i = 0u; i < wanted; ++i)
            heads_there = heads_there && box_distance(volumes[i], ray_start, ray_way) >= 1e30;
        part += heads_there ? 1.0 / float(kRays * kRays) : 0.0;
    }

    vec3 square = cross(own.side.xyz, own.up.xyz);
    float share = length(square);  // area of the patch: m^2, or on the plane at distance 1
    if (!directional) {            // convert to steradians
        float squared = dot(place, place);
        share /= squared * sqrt(squared);
        if (uint(own.direction.w) == kSpotLight) {
            float ramp = clamp((dot(way, own.direction.xyz) - own.cone.y) / (own.cone.x - own.cone.y), 0.0, 1.0);
            share *= ramp * ramp;
        }
    }
    quad.power = own.intensity.rgb * share * part;
    quad.unabsorbed = quad.power;
    quad.volume = PELLUCID_NO_VOLUME;
    quad.front = front;
    quad.reflections = 0u;
    quad.coarse = false;
    quad.optical = directional ? 0.0 : own.position.w;
    quad.surface = vec4(0.0);
    if (!(max(quad.power.r, max(quad.power.g, quad.power.b)) > 0.0)) return;  // no light heads for the box
    add_power(PELLUCID_LIGHT_EMITTED, quad.power);
    uint slot = atomicAdd(state.kept, 1u);  // the patches of all fronts fit into the list
    if (slot < capacity) patches_out[slot] = pack_patch(quad);
}
