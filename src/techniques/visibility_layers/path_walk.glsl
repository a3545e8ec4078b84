#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_WALK_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_WALK_GLSL

// The surfaces that paths meet: the maps that are walked, and which of the surfaces in them a path can meet.
// Needs: visibility_bindings.glsl.
#include "layers/surface_map.glsl"

layout(std430, set = 0, binding = 3) readonly buffer Traits { uint traits[]; };  // per object
layout(std430, set = 0, binding = 4) readonly buffer Solids { uint solids[]; };  // per rank: its material
layout(std430, set = 0, binding = 14) readonly buffer Maps { MapRecord maps[]; };
layout(set = 0, binding = 15) uniform utextureBuffer map_triangles;
layout(set = 0, binding = 29) uniform utextureBuffer map_normals;
layout(set = 0, binding = 16) uniform utextureBuffer texels;
layout(set = 0, binding = 17) uniform utextureBuffer ranges;
layout(set = 0, binding = 28) uniform utextureBuffer records;
layout(set = 0, binding = 22) uniform utextureBuffer pyramid;

#include "techniques/visibility_layers/path_state.glsl"
#include "techniques/visibility_layers/cross_surface.glsl"

// Surfaces for which a volume stands (kReplaced).
const uint kMeetNone = 0u, kMeetEntering = 1u, kMeetAll = 2u;
uint meets_replaced = kMeetNone;

// Rays enter and leave a solid in turn, so a surface that the path stands on is never met again.
bool can_meet(uint traits, bool leaving, uint triangle) {
    if (kVolumes && (traits & kReplaced) != 0u)
        return meets_replaced == kMeetAll || (meets_replaced == kMeetEntering && !leaving && triangle != standing);
    if ((traits & (kKindMask | kClosed)) != (kRefractiveKind | kClosed)) return triangle != standing;
    return (entered(rank_of(traits)) > 0u) == leaving;
}

// Whether what fills the place is drawn by a volume.
bool in_replaced(uint rank) { return kVolumes && rank != kAir && (solids[rank] & kReplacedSolid) != 0u; }

#define PELLUCID_FINDS_SECOND kTouching
#include "layers/object_walk.glsl"

const float kApart = 16.0;  // coincidences along a ray, which may graze

#endif
