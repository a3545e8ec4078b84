#pragma once

#include "gpu/memory.h"
#include "gpu/recorder.h"
#include "gpu/structs.h"

#include <pellucid/scene.h>

#include <vector>

namespace pellucid {

/// A Scene in device memory.
///
/// Vertices are stored per triangle corner, so that a shader knows the triangle from gl_VertexIndex
/// alone: gl_PrimitiveID in a fragment shader would need an optional feature (geometryShader).
struct GpuScene {
    GpuScene(const Device& device, const Scene& scene);

    Buffer geometry;    ///< vertex stream: position, normal (6 floats)
    Buffer appearance;  ///< vertex stream: texcoord 0, texcoord 1 (4 floats), colour (RGBA8)
    Buffer objects;     ///< ObjectRecord[]
    Buffer materials;   ///< MaterialRecord[]
    Buffer textures;    ///< TextureRecord[]
    GpuImage texture_pages;

    std::uint32_t object_count = 0;
    std::uint64_t triangle_count = 0;
    std::vector<std::uint32_t> first_triangles;  ///< per object; ascending
    std::vector<glm::mat4> world_from_object;    ///< per object
    std::vector<DrawCall> refractive;            ///< solids of glass
    std::vector<DrawCall> textured_refractive;   ///< those of them whose surface varies in colour or transmission
    std::vector<DrawCall> thin_walled;           ///< transmissive surfaces that do not bend light
    std::vector<DrawCall> opaque;
    Bounds bounds;
    std::vector<glm::vec3> refractive_corners;  ///< corners of the refractive objects' boxes, world
};

/// Bytes from one vertex of GpuScene::geometry to the next.
inline constexpr std::uint32_t kGeometryStride = 24;

/// Layout of the two vertex streams; pass `with_appearance` where a shader wants locations 2 to 4.
std::vector<std::uint32_t> stream_strides(bool with_appearance);
std::vector<Program::VertexAttribute> vertex_attributes(bool with_appearance);

}  // namespace pellucid
