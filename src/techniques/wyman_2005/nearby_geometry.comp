#version 460
// Wyman, "Interactive Image-Space Refraction of Nearby Geometry", GRAPHITE 2005: refracted rays hit the opaque
// surfaces that the image contains. A ray is followed across the image and compared with the stored depth, first in
// linear, then in binary steps. It starts at the first interface, because the exit is a guess and may lie behind an
// object that touches the glass.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
#include "layers/layers.glsl"
#include "layers/pixel_list.glsl"
#include "techniques/refraction.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, set = 0, binding = 2) readonly buffer Materials { MaterialRecord materials[]; };
layout(set = 0, binding = 3, r32f) readonly uniform image2DArray layer_depth;
layout(set = 0, binding = 4, r32ui) readonly uniform uimage2DArray layer_triangle;
layout(set = 0, binding = 5, rgba32f) uniform image2DArray exit_direction;
layout(set = 0, binding = 6, rgba32f) uniform image2DArray exit_position;
// a: transmittance of the first interface alone
layout(set = 0, binding = 7, rgba32f) uniform image2DArray transmittance;
layout(set = 0, binding = 8, r32ui) uniform uimage2DArray path_events;
layout(set = 0, binding = 9, rgba32f) readonly uniform image2DArray opaque_radiance;
layout(set = 0, binding = 10, r32f) readonly uniform image2DArray opaque_depth;
layout(set = 0, binding = 11, r32ui) readonly uniform uimage2DArray opaque_object;
layout(set = 0, binding = 12, rgba32f) writeonly uniform image2DArray path_radiance;
layout(push_constant) uniform Push {
    uint linear_steps;
    uint binary_steps;
};

#include "layers/objects.glsl"

float stored_depth(ivec2 texel) { return imageLoad(opaque_depth, ivec3(texel, 0)).r; }
#include "gpu/depth_search.glsl"

// Farthest end of a ray from `from`: limited by the scene's depth range.
vec3 ray_end(vec3 from, vec3 direction) {
    float depth = -from.z, rate = -direction.z;
    float far = frame.far_plane < PELLUCID_EMPTY_DEPTH ? frame.far_plane : 1e6 * max(depth, frame.glass_far);
    float limit = max(far, depth) - depth;
    float t = rate > 0.0 ? limit / rate : rate < 0.0 ? max(depth - frame.near_plane, 0.0) / -rate : limit;
    return from + min(t, 1e3 * (limit + depth)) * direction;
}

void store_hit(ivec3 at, ivec2 seen, vec3 position, vec3 share) {
    vec3 world = (frame.world_from_view * vec4(position, 1.0)).xyz;
    imageStore(exit_position, at, vec4(world, float(imageLoad(opaque_object, ivec3(seen, 0)).r)));
    imageStore(path_radiance, at, vec4(share * imageLoad(opaque_radiance, ivec3(seen, 0)).rgb, 1.0));
}

// Ends the path on an object that touches the glass or lies in it, before the exit.
void end_inside(ivec3 at, ivec2 seen, vec3 position, vec3 entry, vec3 direction) {
    vec3 sigma_a = materials[objects[find_object(triangle_index(imageLoad(layer_triangle, at).r))].material].sigma_a.rgb;
    float length_inside = distance(entry, position);
    vec3 share = imageLoad(transmittance, at).a * beer_lambert(sigma_a, length_inside);
    store_hit(at, seen, position, share);
    imageStore(transmittance, at, vec4(share, 1.0));
    imageStore(exit_direction, at, vec4(mat3(frame.world_from_view) * direction, length_inside));
    uint events = imageLoad(path_events, at).r;
    imageStore(path_events, at, uvec4((events & 0x10000000u) | 1u | kStatusOk << 24));  // one interface
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;

    ivec3 at = ivec3(texel, 0);
    imageStore(path_radiance, at, vec4(0.0));
    vec3 entry = view_position(vec2(texel) + 0.5, imageLoad(layer_depth, at).r);
    vec3 exit = (frame.view_from_world * vec4(imageLoad(exit_position, at).xyz, 1.0)).xyz;
    if (-exit.z < frame.near_plane) return;  // the image contains nothing behind the eye
    bool behind = false;                     // nothing opaque occludes the entry
    // A path that ends at its first interface has no segment inside. Inner reflections bend it.
    uint events = imageLoad(path_events, at).r;
    bool straight = (events & 0xfffu) > 1u && (events >> 12 & 0xfffu) == 0u;
    bool goes_inside = straight && distance(entry, exit) > 1e-6 * -entry.z;
    Stretch inside = stretch_of(entry, exit);
    float share = goes_inside ? search(inside, linear_steps, binary_steps, behind) : -1.0;
    if (share >= 0.0) {
        vec3 position = position_at(inside, share);
        end_inside(at, texel_at(inside, share), position, entry, normalize(exit - entry));
        return;
    }
    vec3 direction = mat3(frame.view_from_world) * imageLoad(exit_direction, at).xyz;
    Stretch outside = stretch_of(exit, ray_end(exit, direction));
    share = search(outside, linear_steps, binary_steps, behind);
    if (share < 0.0) return;
    store_hit(at, texel_at(outside, share), position_at(outside, share), imageLoad(transmittance, at).rgb);
}
