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
inline constexpr vk::DeviceSize kMapTexelSize = 8;   ///< size of TexelRecords
inline constexpr vk::DeviceSize kMapFoundSize = 16;  ///< size of a record before it is sorted into its texel
inline constexpr vk::DeviceSize kMapRangeSize = 4;
inline constexpr vk::DeviceSize kMapRecordSize = 8;  ///< size of SurfaceRecord
/// The records of a texel start at a multiple of kMapRangeBlock. Twin of kRangeBlock in surface_map.glsl.
inline constexpr std::uint64_t kMapRangeBlock = 4;
constexpr std::uint64_t whole_range_blocks(std::uint64_t records) {
    return (records + kMapRangeBlock - 1) / kMapRangeBlock * kMapRangeBlock;
}
inline constexpr vk::DeviceSize kMapNodeSize = 16;
inline constexpr vk::DeviceSize kMapTileSize = 8;
/// Formats in which rays read the buffers of a SurfaceMap, except maps and objects. kMapFormat: triangles, ranges and
/// nodes. kMapPairFormat: items of eight bytes.
inline constexpr vk::Format kMapFormat = vk::Format::eR32G32B32A32Uint;
inline constexpr vk::Format kMapPairFormat = vk::Format::eR32G32Uint;

/// The record of a map whose texels, nodes and triangles lie at the start of their buffers.
MapRecord record_of(const MapProjection& projection);
/// Number of texels of a map whose sides are padded to powers of two, and number of nodes of its pyramid.
std::uint64_t texel_count(const MapRecord& record);
std::uint64_t node_count(const MapRecord& record);

/// One of the maps that share the buffers of `map`, and its capacities.
struct MapBuild {
    const SurfaceMap& map;
    MapRecord record;     ///< equal to the record in map.maps
    std::uint32_t index;  ///< of the record in map.maps
    bool of_mesh;  ///< true: map of the mesh at record.first_triangle, in its own frame; false: map of all objects
    std::uint32_t triangle_count;
    std::uint32_t first_record, records;         ///< capacity in map.records
    CountedBuffer& found;                        ///< begun; unsorted records, with a capacity of at least `records`
    CountedBuffer& tiles;                        ///< tiles of large triangles
    std::function<void(std::uint32_t)> counted;  ///< gets the number of needed records once the frame has run
};
/// Records the passes that fill the map.
void build_map(Recorder& recorder, const Frame& frame, const SceneTopology& topology, const MapBuild& build);

/// Dispatch size for shaders with one thread per triangle, in rows that the device allows.
vk::Extent2D threads_for(const Device& device, std::uint32_t triangles);

}  // namespace pellucid
