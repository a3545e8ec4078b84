// Structs of the wavefront tracer that C++ and GLSL share. Their layout follows the rules in gpu/structs.h.
#ifndef PELLUCID_VOLUME_LIGHT_RECORDS_H
#define PELLUCID_VOLUME_LIGHT_RECORDS_H

#ifdef __cplusplus
#include "core/math.h"

#include <cstdint>
namespace pellucid::gpu {
// NOLINTBEGIN(readability-identifier-naming): GLSL's names
using vec4 = glm::vec4;
using uint = std::uint32_t;
// NOLINTEND(readability-identifier-naming)
#endif

// A patch's tag: the volume of its v, its front, its reflections so far, and whether a split has exceeded the capacity.
#define PELLUCID_NO_VOLUME 0xffffu
#define PELLUCID_MOST_FRONTS 0xfffu
#define PELLUCID_MOST_REFLECTIONS 7u

// A patch of a wavefront: four corners in order around it.
struct LightPatch {
    vec4 position[4];  // xyz: world, m. w: power, W (three colours); last: bits of the tag
    // xyz: v, n times the unit direction, world. w: power without absorption, W; last: optical length, m
    vec4 direction[4];
    // The surface that the patch is in: packed direction before it (0: none), n before it, highest and lowest field.
    vec4 surface;
};

// A patch that View::kWavefront shows.
struct ShownPatch {
    vec4 position[4];  // xyz: world, m. w: irradiance, W/m2 (three colours); last: unused
};

// A grid of patches that a light emits towards the box of one volume.
struct LightFront {
    vec4 corner;     // directional: world, m; else on the plane at distance 1 from `position`. w: patches along side
    vec4 side;       // step from one patch to the next; w: patches along up
    vec4 up;         // side, up and the light's direction are right-handed
    vec4 position;   // point and spot: world, m; w: distance from there at which patches begin, m
    vec4 direction;  // directional and spot: unit, world; w: pellucid::Light::Kind
    vec4 intensity;  // rgb: per steradian, or irradiance; w: first power of a patch, W
    vec4 cone;  // x, y: cosines of a spot's inner and outer angle; z: bits of the volume; w: bits of the colour, 0: all
};

// A triangle that stops light.
struct OpaqueTriangle {
    vec4 corner;          // world, m; w: bits of its object
    vec4 edge_b, edge_c;  // from `corner` to the other two corners
};

// A box around opaque triangles.
struct OpaqueNode {
    vec4 low;   // world, m; w: bits of the node after its subtree
    vec4 high;  // w: bits of 8 * first triangle + number of triangles; 0 for inner nodes
};

// Storage of the light in a placed volume.
struct LightPlacement {
    uint first_key;                  // its first voxel in the buffer of voxels
    uint size_x, size_y, size_z;     // voxels of light
    uint first_x, first_y, first_z;  // of its box in the images of light
    uint halvings;                   // a voxel of light is 2^halvings voxels wide
};

#ifdef __cplusplus
static_assert(sizeof(LightPatch) == 144);
static_assert(sizeof(ShownPatch) == 64);
static_assert(sizeof(LightFront) == 112);
static_assert(sizeof(OpaqueTriangle) == 48);
static_assert(sizeof(OpaqueNode) == 32);
static_assert(sizeof(LightPlacement) == 32);
}  // namespace pellucid::gpu
#endif

#endif
