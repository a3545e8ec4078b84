#pragma once

#include "gpu/counted_buffer.h"
#include "gpu/frame.h"
#include "gpu/scene_topology.h"
#include "layers/surface_map.h"

#include <cstdint>
#include <functional>

namespace pellucid {

/// Twin of MapRecord in surface_map.glsl.
struct MapRecord {
    glm::mat4 map_from_space;
    float near_w;
    std::uint32_t width, height, log2_width, log2_height;
    std::uint32_t first_head, first_node, first_triangle;
};
static_assert(sizeof(MapRecord) == 96);

inline constexpr vk::DeviceSize kMapTriangleSize = 48;
inline constexpr vk::DeviceSize kMapTexelSize = 8;   ///< TexelRecords
inline constexpr vk::DeviceSize kMapFoundSize = 16;  ///< a record before it is sorted into its texel
inline constexpr vk::DeviceSize kMapRangeSize = 4;
inline constexpr vk::DeviceSize kMapRecordSize = 8;  ///< SurfaceRecord
/// Records of a texel start at a multiple of it. Twin of kRangeBlock in surface_map.glsl.
inline constexpr std::uint64_t kMapRangeBlock = 4;
constexpr std::uint64_t whole_range_blocks(std::uint64_t records) {
    return (records + kMapRangeBlock - 1) / kMapRangeBlock * kMapRangeBlock;
}
inline constexpr vk::DeviceSize kMapNodeSize = 16;
inline constexpr vk::DeviceSize kMapTileSize = 8;
/// In which rays read what the buffers of a SurfaceMap hold, except the maps and objects: triangles, ranges and nodes,
/// and what has eight bytes.
inline constexpr vk::Format kMapFormat = vk::Format::eR32G32B32A32Uint;
inline constexpr vk::Format kMapPairFormat = vk::Format::eR32G32Uint;

/// Its parts lie at the start of their buffers.
MapRecord record_of(const MapProjection& projection);
/// Of a map, with those beside it that make its sides powers of two; and of its pyramid.
std::uint64_t texel_count(const MapRecord& record);
std::uint64_t node_count(const MapRecord& record);

/// One map among those that share the buffers of `map`, and the room that there is for it.
struct MapBuild {
    const SurfaceMap& map;
    MapRecord record;     ///< as in map.maps,
    std::uint32_t index;  ///< there
    bool of_mesh;  ///< of the mesh that starts at record.first_triangle, in its own frame; otherwise of all objects
    std::uint32_t triangle_count;
    std::uint32_t first_record, records;         ///< capacity in map.records
    CountedBuffer& found;                        ///< begun; records before they are sorted, of at least that capacity
    CountedBuffer& tiles;                        ///< that large triangles are cut into
    std::function<void(std::uint32_t)> counted;  ///< gets the records that it needs, once the frame has run
};
/// Records the passes that fill it.
void build_map(Recorder& recorder, const Frame& frame, const SceneTopology& topology, const MapBuild& build);

/// Threads of the shaders that take a triangle each, in rows that a dispatch may have.
vk::Extent2D threads_for(const Device& device, std::uint32_t triangles);

}  // namespace pellucid
