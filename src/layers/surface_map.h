#pragma once

#include "gpu/frame.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <string>

namespace pellucid {

/// A projection that maps lines to lines. `map_from_world` times a world position gives (X, Y, Q, W). X / W and Y / W
/// count texels. Q / W is a depth that grows away from the eye, 0..1 over the extent of the map.
struct MapProjection {
    glm::mat4 map_from_world{1.0f};
    float near_w = 0.0f;  ///< points of smaller W are not in the map
    vk::Extent2D extent;  ///< texels
};

/// A hierarchy of the scene's triangles for rays. A rasteriser rebuilds it whenever the scene changes.
///
/// Each texel has a list of records: a triangle, and the range of depths at which it crosses the texel. A triangle is
/// listed in every texel that it touches. So the list holds every surface that a ray can meet in the texel. A pyramid
/// over the texels holds up to four depth ranges per node, which cover all of the node's records.
struct SurfaceMap {
    const Buffer* maps;       ///< MapRecord[]
    const Buffer* triangles;  ///< see surface_map.glsl; in world space, or in the frames of meshes
    const Buffer* normals;    ///< normals at the triangles' corners, in the same space
    const Buffer* texels;     ///< TexelRecords[]: per texel, the range of its records
    const Buffer* ranges;     ///< depth range of each record
    const Buffer* records;    ///< SurfaceRecord[]
    const Buffer* pyramid;    ///< uvec4[]: levels from the finest on
    const Buffer* objects;    ///< MappedObject[] (object_walk.glsl) with maps of every mesh; otherwise null
};

/// A map of triangles alone, for finders that walk no map. The other buffers that shaders declare are bound to
/// `triangles`, but never read.
inline SurfaceMap of_triangles(const Buffer& triangles, const Buffer& normals) {
    return {&triangles, &triangles, &normals, &triangles, &triangles, &triangles, &triangles, nullptr};
}
/// Transforms the triangles of all objects to world space.
SurfaceMap place_triangles(Recorder& recorder, const Frame& frame);

}  // namespace pellucid
