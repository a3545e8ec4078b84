#ifndef PELLUCID_TECHNIQUES_WANG_2014_RAY_STATE_GLSL
#define PELLUCID_TECHNIQUES_WANG_2014_RAY_STATE_GLSL

// State shared by the passes of this technique: the object, and the rays, stored in the result images between passes
// (the exit position P2 and direction T2 of section 3.7). Rays are stored in world space and searched in view space.
#extension GL_GOOGLE_include_directive : require
#define PELLUCID_RESULT_ACCESS
#include "techniques/technique_bindings.glsl"
#include "layers/pixel_list.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

// Twin of ObjectSearch in object_passes.h.
layout(push_constant) uniform Push {
    vec4 box_low;  // the object's box: x and y in view space, depth, m
    vec4 box_high;
    uint object;
    uint layer;  // the searched layer
    uint linear_steps;
    uint binary_steps;
    uint last_reflection;  // 1: another total reflection ends the path
    // SIZE of the thesis, in metres of depth. Larger depth differences between neighbouring texels, or between the two
    // ends of a binary search, mean different surfaces.
    float fault_size;
};

Path load_path(ivec2 texel) {
    ivec3 at = ivec3(texel, 0);
    vec4 direction = imageLoad(exit_direction, at);
    uint word = imageLoad(path_events, at).r;
    return Path(imageLoad(exit_position, at).xyz, direction.xyz, imageLoad(transmittance, at).rgb, direction.w,
                word & 0xfffu, (word >> 12) & 0xfffu, (word >> 24) & 0xfu, ((word >> 28) & 1u) != 0u);
}

MaterialRecord object_material() { return materials[objects[object].material]; }

#endif
