#pragma once

#include "techniques/technique.h"

namespace pellucid::wyman_2005 {

/// Source of the distance d.
enum class Distances : std::uint32_t {
    kPerVertex,  ///< d_N of the vertices, and the distance between faces along the view ray
    kSampled,    ///< table over the surface and all directions
    kAlongView,  ///< distance between faces along the view ray only; nothing is baked
};

/// Baked distances on the device.
struct BakedDistances {
    const Buffer& values;   ///< floats
    const Buffer& objects;  ///< BakedObject[], one per object; see baked_distances.glsl
};

/// Bakes the missing distances of every refracting object. `side`: size of the table.
void bake(const Preparation& preparation, Distances distances, std::uint32_t side);

/// The distances baked by bake(). One buffer in the mesh's own frame serves all placements with rotation, translation
/// and uniform scale. Any other placement is baked separately, in world units.
BakedDistances baked_distances(const GpuScene& scene, Distances distances, std::uint32_t side);

}  // namespace pellucid::wyman_2005
