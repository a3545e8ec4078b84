#pragma once

#include "techniques/technique.h"

namespace pellucid::wyman_2005 {

/// Where d comes from.
enum class Distances : std::uint32_t {
    kPerVertex,  ///< d_N of the vertices, and the distance of the faces along the view ray
    kSampled,    ///< the table over the surface and all directions
    kAlongView,  ///< the distance of the faces along the view ray alone; nothing is baked
};

/// Baked distances on the device.
struct BakedDistances {
    const Buffer& values;   ///< floats
    const Buffer& objects;  ///< BakedObject[], one per object; see baked_distances.glsl
};

/// Bakes what is not there yet, of every refracting object. `side` is that of the table.
void bake(const Preparation& preparation, Distances distances, std::uint32_t side);

/// What bake() has left. A buffer of floats in the mesh's own frame serves all its placements that turn, move and scale
/// it alike in all directions; any other placement is baked for itself, in the world's units.
BakedDistances baked_distances(const GpuScene& scene, Distances distances, std::uint32_t side);

}  // namespace pellucid::wyman_2005
