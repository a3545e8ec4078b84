#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_VISIBILITY_BINDINGS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_VISIBILITY_BINDINGS_GLSL

// What the passes of this technique share.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, set = 0, binding = 2) readonly buffer Materials { MaterialRecord materials[]; };
#include "gpu/vertices.glsl"
#include "layers/layers.glsl"
#include "layers/objects.glsl"
#include "layers/pixel_list.glsl"
#include "layers/surface_normal.glsl"
#include "techniques/refraction.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

layout(std430, set = 0, binding = 3) readonly buffer Traits { uint traits[]; };  // per object
layout(std430, set = 0, binding = 4) readonly buffer Solids { uint solids[]; };  // per rank: its material
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)

#include "techniques/visibility_layers/path_state.glsl"
#include "techniques/visibility_layers/cross_surface.glsl"

#endif
