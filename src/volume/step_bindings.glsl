#ifndef PELLUCID_VOLUME_STEP_BINDINGS_GLSL
#define PELLUCID_VOLUME_STEP_BINDINGS_GLSL

// Declarations that step_light.glsl and both kinds of light storage (sum_light.glsl, brightest_light.glsl) share.

layout(local_size_x = 64) in;

layout(constant_id = 0) const bool kMedium = false;       // a volume absorbs or scatters
layout(constant_id = 1) const bool kScatters = false;
layout(constant_id = 2) const bool kOverlapping = false;  // boxes of volumes overlap
layout(constant_id = 3) const bool kOpaque = false;       // there are opaque surfaces
layout(constant_id = 4) const bool kKeepFolds = true;
layout(constant_id = 5) const bool kBoundary = false;     // surfaces reflect
layout(constant_id = 7) const bool kShown = false;        // patches are collected for View::kWavefront

layout(set = 0, binding = 0) uniform texture3D volume_index;
layout(set = 0, binding = 13) uniform texture3D volume_bricks;
layout(set = 0, binding = 1) uniform texture3D volume_absorption;
layout(set = 0, binding = 2) uniform texture3D volume_scattering;

#include "gpu/octahedral.glsl"
#include "volume/volume_field.glsl"
#include "optics/eikonal.glsl"
#include "optics/transmittance.glsl"
#include "volume/light_patch.glsl"
#include "optics/interface.glsl"
#include "volume/smoothed_surface.glsl"
#include "volume/light_surface.glsl"
#include "volume/light_corner.glsl"
#include "volume/mirror_light.glsl"

layout(std430, set = 0, binding = 3) readonly buffer Volumes { VolumeRecord volumes[]; };
layout(std430, set = 0, binding = 4) readonly buffer Placements { LightPlacement placements[]; };
layout(std430, set = 0, binding = 5) readonly buffer OpaqueNodes { OpaqueNode opaque_nodes[]; };
layout(std430, set = 0, binding = 15) readonly buffer OpaqueTriangles { OpaqueTriangle opaque_triangles[]; };
#include "volume/opaque_tree.glsl"
layout(std430, set = 0, binding = 6) readonly buffer Fronts { LightFront fronts[]; };
layout(std430, set = 0, binding = 7) buffer State { LightState state; };
#include "volume/light_power.glsl"
layout(std430, set = 0, binding = 8) readonly buffer PatchesIn { LightPatch patches_in[]; };
layout(std430, set = 0, binding = 9) writeonly buffer PatchesOut { LightPatch patches_out[]; };
layout(std430, set = 0, binding = 10) writeonly buffer Landed { LightPatch landed[]; };
layout(std430, set = 0, binding = 14) writeonly buffer Shown { ShownPatch shown[]; };

// Light that a patch leaves in the voxels that it passes in one step.
struct PassingLight {
    vec3 from[4], to[4];  // corners, voxels
    vec3 way;             // unit
    float area;           // projected along `way`, voxels^2; negative past a focus
    vec3 power;           // W, at the end of the step
    vec3 mean_power;      // W, mean over the step
    float length_m;
    float first_share;    // unabsorbed power, relative to the first power of patches of the front
    uint step_number;
};

#endif
