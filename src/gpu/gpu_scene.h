#pragma once

#include "gpu/memory.h"
#include "gpu/recorder.h"
#include "gpu/scene_topology.h"
#include "gpu/structs.h"

#include <pellucid/scene.h>

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pellucid {

/// A mesh of a GpuScene.
struct GpuMesh {
    std::uint32_t first_corner;  ///< in GpuScene::indices
    std::uint32_t triangle_count;
    glm::vec3 low, high;      ///< its box, in its own frame; empty (low > high) without vertices
    std::uint64_t moves = 0;  ///< GpuScene::moves when it last moved
};

/// What is kept with a scene by a room that this one does not know.
struct PreparedState {
    virtual ~PreparedState() = default;
};

/// A Scene in device memory.
///
/// Shaders fetch vertices from storage buffers (vertices.glsl): vertex shaders by gl_VertexIndex, which counts
/// triangle corners and so tells the triangle (gl_PrimitiveID in a fragment shader would need an optional
/// feature, geometryShader), compute shaders by the triangle of a layer record.
struct GpuScene {
    GpuScene(const Device& device, const Scene& scene);

    /// The next frame sees the vertices of the `moved` meshes as `scene` has them now; all else of it is as it was.
    void move_vertices(const Device& device, const Scene& scene, std::span<const int> moved);

    /// The next frame sees the `moved` objects where `scene` has them now.
    void move_objects(const Device& device, const Scene& scene, std::span<const int> moved);

    /// The next frame sees a material as `scene` has it now, whose textures are as they were.
    void set_material(const Device& device, const Scene& scene, std::size_t material, bool was_refractive);

    /// The lights from the next frame on.
    void set_lights(const Device& device, std::span<const Light> given);

    /// Lists the triangles that emit light, as `scene` is now.
    void list_emitters(const Device& device, const Scene& scene);

    /// Makes `topology`, or brings it up to date; `scene` as it is now.
    void prepare_topology(const Device& device, const Scene& scene);

    Buffer indices;     ///< per triangle corner, the vertex; meshes one after the other
    Buffer vertices;    ///< per vertex: position, normal (6 floats, in the frame of its mesh)
    Buffer appearance;  ///< per vertex: texcoord 0, texcoord 1 (4 floats), colour (RGBA8)
    Buffer objects;     ///< ObjectRecord[]
    Buffer materials;   ///< MaterialRecord[]
    Buffer finishes;    ///< FinishRecord[]
    Buffer tangents;    ///< per vertex, of scenes that have some: see tangents.glsl
    Buffer textures;    ///< TextureRecord[]
    GpuImage texture_pages;
    Buffer lights;  ///< PunctualLight[] (punctual_light.glsl)
    std::uint32_t light_count = 0;
    Buffer emitters;  ///< EmitterRecord[] (emitters.h)
    std::uint32_t emitter_count = 0;
    float emitted_power = 0.0f;  ///< W/sr, of all triangles and channels along the normals; textures count as white

    std::uint32_t object_count = 0;
    std::uint64_t triangle_count = 0;
    std::uint32_t vertex_count = 0;
    std::uint64_t moves = 0;  ///< how often vertices have moved; what is derived from them is as old as its count
    std::vector<GpuMesh> meshes;
    std::vector<std::uint64_t> object_moves;     ///< per object, `moves` when it last moved as a whole; empty: none has
    std::vector<std::uint32_t> first_triangles;  ///< per object; ascending
    std::vector<std::uint32_t> mesh_of_object;
    std::vector<glm::mat4> world_from_object;  ///< per object
    std::vector<DrawCall> refractive;          ///< solids of glass
    std::vector<DrawCall> thin_walled;         ///< transmissive surfaces that do not bend light
    bool rough_glass = false;                  ///< some refracting object is rough
    bool textured_glass = false;               ///< glass of any kind varies along its surface
    bool dispersive = false;                   ///< some refracting object disperses
    bool finished = false;  ///< some opaque object has a Finish, a normal texture or an occlusion texture
    std::vector<DrawCall> opaque;
    std::vector<DrawCall> translucent;  ///< those of them that let light of lights through
    bool rough = false;                 ///< something reflects or refracts a blurred environment
    Bounds bounds;
    std::vector<glm::vec3> refractive_corners;   ///< corners of the refractive objects' boxes, world
    std::vector<glm::vec3> translucent_corners;  ///< of the translucent ones
    std::optional<SceneTopology> topology;       ///< see prepare_topology()
    std::unique_ptr<PreparedState> host_finder;  ///< HostFinder (layers/host_finder.h), where a technique asks for it
    std::unique_ptr<PreparedState> volumes;  ///< SceneVolumes (volume/scene_volumes.h), where a technique draws them
    /// What techniques have computed from the scene, by name; kept as long as the scene is.
    std::map<std::string, Buffer, std::less<>> prepared;

private:
    /// Fills all that follows from the scene's objects and materials.
    std::vector<gpu::ObjectRecord> list_objects(const Scene& scene);
    std::vector<gpu::MaterialRecord> material_records;
    std::vector<gpu::FinishRecord> finish_records;
};

/// Appends the eight corners of a mesh's box, world, m.
void append_box_corners(const Mesh& mesh, const glm::mat4& world_from_object, std::vector<glm::vec3>& corners);

/// Bytes from one vertex of GpuScene::vertices to the next.
inline constexpr std::uint32_t kVertexStride = 24;

}  // namespace pellucid
