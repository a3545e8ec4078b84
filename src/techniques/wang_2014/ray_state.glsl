#ifndef PELLUCID_TECHNIQUES_WANG_2014_RAY_STATE_GLSL
#define PELLUCID_TECHNIQUES_WANG_2014_RAY_STATE_GLSL

// What the passes of this technique share: the object that they are about, and the rays, which live in the images
// of the result from pass to pass (the exit position P2 and direction T2 of section 3.7). Rays are in world space
// here, and searched for in view space.
#extension GL_GOOGLE_include_directive : require
#define PELLUCID_RESULT_ACCESS
#include "techniques/technique_bindings.glsl"
#include "layers/pixel_list.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

// Twin of Push in wang_2014.cpp.
layout(push_constant) uniform Push {
    vec4 box_low;  // of the object: x and y in view space, depth, m
    vec4 box_high;
    uint object;
    uint layer;  // that is searched
    uint linear_steps;
    uint binary_steps;
    uint last_reflection;  // 1: a further total reflection ends the path
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
