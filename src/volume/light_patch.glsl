#ifndef PELLUCID_VOLUME_LIGHT_PATCH_GLSL
#define PELLUCID_VOLUME_LIGHT_PATCH_GLSL

// Patches of wavefronts, and data that the passes of the tracer share (Ihrke et al. 2007, section 4.2).

#include "volume/box.glsl"
#include "volume/light_records.h"
#include "volume/light_state.h"
#include "volume/wide_counter.glsl"

// Twin of LightPush in wavefront.cpp.
layout(push_constant) uniform Push {
    uint capacity;          // patches that a list holds
    uint volume_count;
    uint opaque_count;      // nodes of the tree of opaque triangles
    uint front;             // emit_light: index of the front
    float step_length;      // optical length of a step, voxels
    float span;             // longest side of a patch before it is split, voxels
    float least_area;       // least area of a patch when its light is written to a voxel, voxels^2
    uint steps_per_round;
    float power_scale;      // fixed-point units per W
    float finest;           // share of its first power below which a patch is not split
    float weakest;          // share of its first power below which a patch ends
    uint reflections;       // most successive reflections that are followed
    float shown_spacing;    // optical length between shown wavefronts, m
    float photon_spacing;   // wanted spacing of photons where patches land, m
    float least_radius;     // of photons' kernels, m
    float most_photons;     // most photons of a patch with all its first power; proportional to power for others
};

struct Quad {
    vec3 x[4];
    vec3 v[4];
    vec3 power;       // W
    vec3 unabsorbed;  // power without absorption, W
    uint volume;      // the volume to which v belongs
    uint front;
    uint reflections; // number of reflections so far
    bool coarse;      // a split failed for lack of capacity
    float optical;    // optical length from the light, m
    vec4 surface;     // as LightPatch::surface
};

Quad unpack_patch(LightPatch patch_) {
    Quad quad;
    for (int k = 0; k < 4; ++k) {
        quad.x[k] = patch_.position[k].xyz;
        quad.v[k] = patch_.direction[k].xyz;
    }
    quad.power = vec3(patch_.position[0].w, patch_.position[1].w, patch_.position[2].w);
    quad.unabsorbed = vec3(patch_.direction[0].w, patch_.direction[1].w, patch_.direction[2].w);
    uint tag = floatBitsToUint(patch_.position[3].w);
    quad.volume = tag & 0xffffu;
    quad.front = tag >> 16 & PELLUCID_MOST_FRONTS;
    quad.reflections = tag >> 28 & PELLUCID_MOST_REFLECTIONS;
    quad.coarse = tag >> 31 != 0u;
    quad.optical = patch_.direction[3].w;
    quad.surface = patch_.surface;
    return quad;
}

LightPatch pack_patch(Quad quad) {
    LightPatch patch_;
    for (int k = 0; k < 4; ++k) {
        patch_.position[k].xyz = quad.x[k];
        patch_.direction[k].xyz = quad.v[k];
    }
    patch_.position[0].w = quad.power.r;
    patch_.position[1].w = quad.power.g;
    patch_.position[2].w = quad.power.b;
    patch_.position[3].w =
        uintBitsToFloat(quad.volume | quad.front << 16 | quad.reflections << 28 | (quad.coarse ? 1u << 31 : 0u));
    patch_.direction[0].w = quad.unabsorbed.r;
    patch_.direction[1].w = quad.unabsorbed.g;
    patch_.direction[2].w = quad.unabsorbed.b;
    patch_.direction[3].w = quad.optical;
    patch_.surface = quad.surface;
    return patch_;
}

uvec2 power_units(float power) { return fixed_point(max(power, 0.0) * power_scale + 0.5); }

#endif
