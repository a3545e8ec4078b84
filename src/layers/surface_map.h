#pragma once

#include "gpu/frame.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <string>

namespace pellucid {

/// A view of space in which lines stay lines: `map_from_world` times a world position gives (X, Y, Q, W); X / W and
/// Y / W count texels, Q / W is a depth that grows away from the eye, 0..1 over what the map holds.
struct MapProjection {
    glm::mat4 map_from_world{1.0f};
    float near_w = 0.0f;  ///< what has a smaller W is not in the map
    vk::Extent2D extent;  ///< texels
};

/// Which triangles of the scene lie in which texel, and how deep: a hierarchy for rays that the rasteriser makes anew
/// whenever the scene changes.
///
/// Per texel a list of records, each a triangle and the range of depths at which its surface crosses the texel. A
/// triangle is in every texel that it touches: what a ray meets in a texel is in its list.
/// Over the texels a pyramid of depth ranges: up to four per node, in which all of its records lie.
struct SurfaceMap {
    const Buffer* maps;       ///< MapRecord[]
    const Buffer* triangles;  ///< see surface_map.glsl; in the world, or in the frames of meshes
    const Buffer* normals;    ///< of their corners, likewise
    const Buffer* texels;     ///< TexelRecords[]: per texel, where its records lie
    const Buffer* ranges;     ///< depths of each record
    const Buffer* records;    ///< SurfaceRecord[]
    const Buffer* pyramid;    ///< uvec4[]: levels from the finest on
    const Buffer*
        objects;  ///< where there are maps of every mesh: MappedObject[], see object_walk.glsl; otherwise null
};

/// What takes the place of a map where none is walked: triangles alone. Everything else that shaders declare is bound to
/// them, and not looked at.
inline SurfaceMap of_triangles(const Buffer& triangles, const Buffer& normals) {
    return {&triangles, &triangles, &normals, &triangles, &triangles, &triangles, &triangles, nullptr};
}
/// The triangles of all objects, placed in the world.
SurfaceMap place_triangles(Recorder& recorder, const Frame& frame);

}  // namespace pellucid
