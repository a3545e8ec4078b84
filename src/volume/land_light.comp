#version 460
// Puts the light of patches that have left the volumes onto receivers: every patch as a grid of rays, so that its power is
// spread over what it covers and none is lost; a ray's power goes to the four texels around its end.
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 64) in;

#include "volume/volume_record.glsl"
#include "volume/light_patch.glsl"
#include "volume/light_plane.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Receivers { LightReceiver receivers[]; };
layout(std430, set = 0, binding = 1) buffer State { LightState state; };
#include "volume/light_power.glsl"
layout(std430, set = 0, binding = 2) readonly buffer Landed { LightPatch landed[]; };
// Wide counters, three colours each: the light that arrives, and in a second half what would arrive without volumes.
layout(std430, set = 0, binding = 3) buffer Texels { uint texels[]; };

layout(constant_id = 0) const bool kStraight = false;  // patches as the light emits them, as if there were no volumes

const float kRaysPerTexel = 3.0;
const int kMostRays = 48;  // along a side of a patch

// The first receiver on a ray, which may have passed it by `slack`.
uint nearest_receiver(vec3 position, vec3 direction, float slack, out vec2 texel) {
    uint found = receiver_count;
    float nearest = 1e30;
    texel = vec2(0.0);
    for (uint i = 0u; i < receiver_count; ++i) {
        vec2 at;
        float t = receiver_distance(receivers[i], position, direction, at);
        if (t >= -slack && t < nearest) {
            nearest = t;
            found = i;
            texel = at;
        }
    }
    return found;
}

void add_texel(LightReceiver receiver, ivec2 at, vec3 power) {
    ivec2 size = ivec2(receiver.side.w, receiver.up.w);
    at = clamp(at, ivec2(0), size - 1);
    uint texel = floatBitsToUint(receiver.normal.w) + uint(at.x + size.x * at.y);
    if (kStraight) texel += uint(texels.length()) / 12u;
    for (int c = 0; c < 3; ++c)
        if (power[c] > 0.0) {
            uvec2 units = power_units(power[c]);
            PELLUCID_ADD_WIDE(texels, 3u * texel + c, units)
        }
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= (kStraight ? state.in_kept : state.landing)) return;
    Quad quad = unpack_patch(landed[i]);
    for (int k = 0; k < 4; ++k) quad.v[k] = normalize(quad.v[k]);
    float slack = max(distance(quad.x[0], quad.x[2]), distance(quad.x[1], quad.x[3]));
    // As many rays as the patch is wide where it lands.
    vec2 place;
    vec3 centre = 0.25 * (quad.x[0] + quad.x[1] + quad.x[2] + quad.x[3]);
    vec3 way = normalize(quad.v[0] + quad.v[1] + quad.v[2] + quad.v[3]);
    uint target = nearest_receiver(centre, way, slack, place);
    ivec2 rays = ivec2(8);
    if (target < receiver_count) {
        vec2 at[4];
        for (int k = 0; k < 4; ++k) receiver_distance(receivers[target], quad.x[k], quad.v[k], at[k]);
        vec2 wide = vec2(max(distance(at[0], at[1]), distance(at[3], at[2])),
                         max(distance(at[0], at[3]), distance(at[1], at[2])));
        rays = ivec2(clamp(ceil(kRaysPerTexel * wide), vec2(1.0), vec2(kMostRays)));
    }
    if (receiver_count == 0u) rays = ivec2(1);
    vec3 power = quad.power / float(rays.x * rays.y);
    vec3 arrived = vec3(0.0), missed = vec3(0.0);
    for (int ray = 0; ray < rays.x * rays.y; ++ray) {
        vec2 at = (vec2(ray % rays.x, ray / rays.x) + 0.5) / vec2(rays);
        vec3 x = mix(mix(quad.x[0], quad.x[1], at.x), mix(quad.x[3], quad.x[2], at.x), at.y);
        vec3 v = mix(mix(quad.v[0], quad.v[1], at.x), mix(quad.v[3], quad.v[2], at.x), at.y);
        vec2 texel;
        uint met = nearest_receiver(x, normalize(v), slack, texel);
        if (met == receiver_count) {
            missed += power;
            continue;
        }
        arrived += power;
        vec2 corner = floor(texel - 0.5), w = texel - 0.5 - corner;
        for (int k = 0; k < 4; ++k) {
            ivec2 offset = ivec2(k & 1, k >> 1);
            vec2 share = mix(1.0 - w, w, vec2(offset));
            add_texel(receivers[met], ivec2(corner) + offset, power * share.x * share.y);
        }
    }
    if (kStraight) return;
    add_power(PELLUCID_LIGHT_ARRIVED, arrived);
    add_power(PELLUCID_LIGHT_MISSED, missed);
    add_power(PELLUCID_LIGHT_ABSORBED, quad.unabsorbed - quad.power);
}
