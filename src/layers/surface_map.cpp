// Compute shaders rasterise the triangles, because the hardware skips a triangle that covers no texel centre.
#include "layers/surface_map.h"

#include "layers/layers.h"
#include "layers/map_building.h"
#include "layers/shaders.h"

#include <algorithm>
#include <array>
#include <bit>

namespace pellucid {
namespace {

/// Twin of kNoRange in surface_map.glsl.
constexpr std::uint32_t kNoRange = 0x0000ffff;

std::uint32_t log2_ceil(std::uint32_t size) { return std::uint32_t(std::bit_width(size - 1)); }

const Buffer& triangle_buffer(const Frame& frame, const char* name) {
    const std::uint64_t triangles = std::max<std::uint64_t>(frame.scene.triangle_count, 1);
    return frame.workspace.buffer(name, triangles * kMapTriangleSize, false, kMapFormat);
}

}  // namespace

MapRecord record_of(const MapProjection& projection) {
    MapRecord record{};
    record.map_from_space = projection.map_from_world;
    record.near_w = projection.near_w;
    record.width = projection.extent.width;
    record.height = projection.extent.height;
    record.log2_width = log2_ceil(record.width);
    record.log2_height = log2_ceil(record.height);
    return record;
}

std::uint64_t texel_count(const MapRecord& record) { return 1ull << (record.log2_width + record.log2_height); }
std::uint64_t node_count(const MapRecord& record) { return 4 * texel_count(record) / 3 + 1; }

vk::Extent2D threads_for(const Device& device, std::uint32_t triangles) {
    constexpr std::uint32_t kGroup = 64;  // workgroup size of the shaders that process triangles
    const std::uint32_t row_groups = device.limits().maxComputeWorkGroupCount[0];
    const std::uint32_t groups = (triangles + kGroup - 1) / kGroup, rows = groups / row_groups + 1;
    return {(groups + rows - 1) / rows * kGroup, rows};
}

void build_map(Recorder& recorder, const Frame& frame, const SceneTopology& topology, const MapBuild& build) {
    Workspace& workspace = frame.workspace;
    const GpuScene& scene = frame.scene;
    const SurfaceMap& map = build.map;
    const MapRecord& record = build.record;
    const std::uint32_t texels = std::uint32_t(texel_count(record));
    const Buffer& found = build.found.buffer();
    const Buffer& tiles = build.tiles.begin(recorder, workspace, texels / 4 + 1024);

    recorder.fill(*map.texels, record.first_head * kMapTexelSize, texels * kMapTexelSize, 0);
    recorder.fill(*map.ranges, build.first_record * kMapRangeSize, build.records * kMapRangeSize, kNoRange);
    const vk::Extent2D threads = threads_for(workspace.device(), build.triangle_count);
    // Records of a mesh's map belong to no object. The walk adds the traits of the object.
    const bool one_object = build.of_mesh || scene.object_count == 1;
    recorder.compute(
        workspace.compute(shaders::rasterise_surfaces_comp, {{"kOfMesh", build.of_mesh}, {"kOneObject", one_object}}),
        {frame.bindings(), reads("Maps", *map.maps), writes("MapTriangles", *map.triangles),
         writes("MapNormals", *map.normals), updates("Texels", *map.texels), updates("Found", found),
         updates("Tiles", tiles)},
        std::array{build.triangle_count, build.index, threads.width}, threads);
    recorder.compute_indirect(workspace.compute(shaders::rasterise_tiles_comp),
                              {reads("Maps", *map.maps), reads("MapTriangles", *map.triangles),
                               updates("Texels", *map.texels), updates("Found", found), reads("Tiles", tiles)},
                              build.index, build.tiles.groups(recorder, workspace));
    recorder.compute(workspace.compute(shaders::place_texels_comp),
                     {reads("Maps", *map.maps), updates("Found", found), updates("Texels", *map.texels)},
                     std::array{build.index, build.first_record}, {(texels + 15) / 16, 1});
    recorder.compute_indirect(workspace.compute(shaders::place_records_comp, {{"kOneObject", one_object},
                                                                              {"kOfMesh", build.of_mesh},
                                                                              {"kManySlots", topology.many_slots}}),
                              {frame.bindings(), reads("Traits", topology.traits),
                               reads("ShellTraits", topology.shell_traits), reads("texels", *map.texels),
                               reads("found", found), writes("Ranges", *map.ranges), writes("Records", *map.records)},
                              build.first_record + build.records, build.found.groups(recorder, workspace));
    build.found.end(recorder, build.counted);
    build.tiles.end(recorder);

    const vk::Extent2D padded{1u << record.log2_width, 1u << record.log2_height};
    recorder.compute(workspace.compute(shaders::summarise_texels_comp),
                     {reads("Maps", *map.maps), reads("texels", *map.texels), reads("ranges", *map.ranges),
                      writes("Pyramid", *map.pyramid)},
                     build.index, padded);
    for (std::uint32_t level = 1; level <= std::min(record.log2_width, record.log2_height); ++level) {
        recorder.compute(workspace.compute(shaders::reduce_texels_comp),
                         {reads("Maps", *map.maps), updates("Pyramid", *map.pyramid)}, std::array{build.index, level},
                         {texels >> 2 * level, 1});
    }
}

SurfaceMap place_triangles(Recorder& recorder, const Frame& frame) {
    const Buffer& triangles = triangle_buffer(frame, "map triangles");
    const Buffer& normals = triangle_buffer(frame, "map normals");
    const auto count = std::uint32_t(frame.scene.triangle_count);
    const vk::Extent2D threads = threads_for(frame.workspace.device(), count);
    recorder.compute(frame.workspace.compute(shaders::place_triangles_comp),
                     {frame.bindings(), writes("MapTriangles", triangles), writes("MapNormals", normals)},
                     std::array{count, threads.width}, threads);
    return of_triangles(triangles, normals);
}

SurfaceMap LayerSource::map_surfaces(Recorder& recorder, const Frame& frame, const SceneTopology& topology,
                                     const MapProjection& projection) {
    Workspace& workspace = frame.workspace;
    const MapRecord record = record_of(projection);
    const std::uint64_t texels = texel_count(record);
    CountedBuffer& found = counted("surfaces in texels", kMapFoundSize, kMapFormat);
    found.begin(recorder, workspace, 4 * texels);
    const Buffer& maps = workspace.buffer("map projections", sizeof(MapRecord));
    recorder.write(maps, record);
    const auto buffer = [&](const char* name, vk::DeviceSize size, vk::Format format) {
        return &workspace.buffer(name, size, false, format);
    };
    const SurfaceMap map{&maps,
                         &triangle_buffer(frame, "map triangles"),
                         &triangle_buffer(frame, "map normals"),
                         buffer("map texels", texels * kMapTexelSize, kMapPairFormat),
                         buffer("map ranges", whole_range_blocks(found.capacity()) * kMapRangeSize, kMapFormat),
                         buffer("map records", found.capacity() * kMapRecordSize, kMapPairFormat),
                         buffer("map pyramid", node_count(record) * kMapNodeSize, kMapFormat),
                         nullptr};
    build_map(recorder, frame, topology,
              {map,
               record,
               0,
               false,
               std::uint32_t(frame.scene.triangle_count),
               0,
               found.capacity(),
               found,
               counted("tiles of large triangles", kMapTileSize),
               {}});
    return map;
}

}  // namespace pellucid
