// Triangles are rasterised in compute: what a fragment shader sees leaves out what covers no texel's centre.
#include "layers/surface_map.h"

#include "layers/layers.h"
#include "layers/map_building.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace pellucid {
namespace {

constexpr std::uint32_t kRasteriseSurfaces[] = {
#include "rasterise_surfaces.comp.inc"
};
constexpr std::uint32_t kRasteriseTiles[] = {
#include "rasterise_tiles.comp.inc"
};
constexpr std::uint32_t kDispatchMap[] = {
#include "dispatch_map.comp.inc"
};
constexpr std::uint32_t kPlaceTexels[] = {
#include "place_texels.comp.inc"
};
constexpr std::uint32_t kPlaceRecords[] = {
#include "place_records.comp.inc"
};
constexpr std::uint32_t kSummariseTexels[] = {
#include "summarise_texels.comp.inc"
};
constexpr std::uint32_t kReduceTexels[] = {
#include "reduce_texels.comp.inc"
};
constexpr std::uint32_t kPlaceTriangles[] = {
#include "place_triangles.comp.inc"
};

/// Twin of kNoRange in surface_map.glsl.
constexpr std::uint32_t kNoRange = 0x0000ffff;

constexpr std::uint32_t kGroup = 64;  // of the shaders that go through triangles

std::uint32_t log2_ceil(std::uint32_t size) { return std::uint32_t(std::bit_width(size - 1)); }

/// Invocations in a row of a dispatch over `count` triangles, and rows.
std::array<std::uint32_t, 2> rows_of(const Device& device, std::uint32_t count) {
    const std::uint32_t groups = (count + kGroup - 1) / kGroup;
    const std::uint32_t rows = groups / device.limits().maxComputeWorkGroupCount[0] + 1;
    return {(groups + rows - 1) / rows * kGroup, rows};
}

const Buffer& triangle_buffer(const Frame& frame, const char* name) {
    const std::uint64_t triangles = std::max<std::uint64_t>(frame.scene.triangle_count, 1);
    return frame.workspace.buffer(name, triangles * kMapTriangleSize, false, kMapFormat);
}

const Buffer& counts_on_host(const Frame& frame) {
    return frame.workspace.buffer("map counts", sizeof(MapCount), true);
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

std::uint32_t most_map_items(const Device& device, vk::DeviceSize item_size) {
    const vk::DeviceSize bytes = std::min<vk::DeviceSize>(device.max_storage_binding(), device.max_allocation());
    const vk::DeviceSize most =
        std::min<vk::DeviceSize>(bytes / item_size, std::min(device.limits().maxTexelBufferElements, 0x7ffffffeu));
    return std::uint32_t(most / kMapRangeBlock * kMapRangeBlock);
}

std::uint32_t room_for(const Device& device, std::uint32_t room, std::uint32_t needed, vk::DeviceSize item_size,
                       std::string_view what) {
    if (needed <= room) return room;
    const std::uint32_t most = most_map_items(device, item_size);
    if (needed > most) {
        throw TooLarge(fmt::format("{} {} in the picture; {} has room for {}", needed, what, device.info().name, most));
    }
    return std::uint32_t(std::min<std::uint64_t>(most, whole_range_blocks(std::uint64_t(needed) + needed / 4)));
}

void build_map(Recorder& recorder, const Frame& frame, const SceneTopology& topology, const MapBuild& build,
               const Buffer& counts) {
    Workspace& workspace = frame.workspace;
    const GpuScene& scene = frame.scene;
    const SurfaceMap& map = build.map;
    const MapRecord& record = build.record;
    const Buffer& counters = workspace.buffer("map counters", sizeof(MapCount));
    const Buffer& found = workspace.buffer("map records found", build.found * kMapFoundSize, false, kMapFormat);
    const Buffer& groups = workspace.buffer("map workgroups", 3 * sizeof(std::uint32_t));
    const Buffer& tiles = workspace.buffer("map tiles", build.tiles * kMapTileSize);

    recorder.fill(counters, 0);
    const std::uint32_t texels = std::uint32_t(texel_count(record));
    recorder.fill(*map.texels, record.first_head * kMapTexelSize, texels * kMapTexelSize, 0);
    recorder.fill(*map.ranges, build.first_record * kMapRangeSize, build.records * kMapRangeSize, kNoRange);
    const std::uint32_t row_groups = workspace.device().limits().maxComputeWorkGroupCount[0];
    const auto [row, rows] = rows_of(workspace.device(), build.triangle_count);
    struct Push {
        std::uint32_t triangle_count, record_capacity, tile_capacity, map_index, row;
    };
    // Records of a mesh are of no object: whoever walks it for one knows that object's traits.
    const std::uint32_t one_object = build.of_mesh || scene.object_count == 1 ? 1 : 0;
    recorder.compute(
        workspace.compute({"rasterise_surfaces.comp", kRasteriseSurfaces}, {build.of_mesh ? 1u : 0u, one_object}),
        {reads("Frame", frame.constants), reads("Objects", scene.objects), reads("Indices", scene.indices),
         reads("Vertices", scene.vertices), reads("Maps", *map.maps), writes("MapTriangles", *map.triangles),
         writes("MapNormals", *map.normals), updates("MapCounters", counters), updates("Texels", *map.texels),
         writes("Found", found), writes("Tiles", tiles)},
        Push{build.triangle_count, build.found, build.tiles, build.index, row}, {row, rows});
    const Program& dispatch = workspace.compute({"dispatch_map.comp", kDispatchMap});
    recorder.compute(dispatch, {updates("MapCounters", counters), writes("Groups", groups)},
                     std::array{0u, build.tiles, row_groups}, {1, 1});
    recorder.compute_indirect(
        workspace.compute({"rasterise_tiles.comp", kRasteriseTiles}),
        {reads("Maps", *map.maps), reads("MapTriangles", *map.triangles), updates("MapCounters", counters),
         updates("Texels", *map.texels), writes("Found", found), reads("Tiles", tiles)},
        std::array{build.found, build.tiles, build.index}, groups);
    recorder.compute(workspace.compute({"place_texels.comp", kPlaceTexels}),
                     {reads("Maps", *map.maps), updates("MapCounters", counters), updates("Texels", *map.texels)},
                     std::array{build.index, build.first_record}, {(texels + 15) / 16, 1});
    recorder.compute(dispatch, {updates("MapCounters", counters), writes("Groups", groups)},
                     std::array{1u, build.found, row_groups}, {1, 1});
    recorder.compute_indirect(
        workspace.compute({"place_records.comp", kPlaceRecords},
                          {one_object, build.of_mesh ? 1u : 0u, topology.many_slots ? 1u : 0u}),
        {reads("Frame", frame.constants), reads("Objects", scene.objects), reads("Traits", topology.traits),
         reads("ShellTraits", topology.shell_traits), updates("MapCounters", counters), reads("texels", *map.texels),
         reads("found", found), writes("Ranges", *map.ranges), writes("Records", *map.records)},
        std::array{build.found, build.first_record + build.records}, groups);
    recorder.copy(counters, counts, sizeof(MapCount), build.index * sizeof(MapCount));

    const vk::Extent2D padded{1u << record.log2_width, 1u << record.log2_height};
    recorder.compute(workspace.compute({"summarise_texels.comp", kSummariseTexels}),
                     {reads("Maps", *map.maps), reads("texels", *map.texels), reads("ranges", *map.ranges),
                      writes("Pyramid", *map.pyramid)},
                     build.index, padded);
    for (std::uint32_t level = 1; level <= std::min(record.log2_width, record.log2_height); ++level) {
        recorder.compute(workspace.compute({"reduce_texels.comp", kReduceTexels}),
                         {reads("Maps", *map.maps), updates("Pyramid", *map.pyramid)}, std::array{build.index, level},
                         {texels >> 2 * level, 1});
    }
}

SurfaceMap place_triangles(Recorder& recorder, const Frame& frame) {
    const GpuScene& scene = frame.scene;
    const Buffer& triangles = triangle_buffer(frame, "map triangles");
    const Buffer& normals = triangle_buffer(frame, "map normals");
    const auto count = std::uint32_t(scene.triangle_count);
    const auto [row, rows] = rows_of(frame.workspace.device(), count);
    recorder.compute(
        frame.workspace.compute({"place_triangles.comp", kPlaceTriangles}),
        {reads("Frame", frame.constants), reads("Objects", scene.objects), reads("Indices", scene.indices),
         reads("Vertices", scene.vertices), writes("MapTriangles", triangles), writes("MapNormals", normals)},
        std::array{count, row}, {row, rows});
    return of_triangles(triangles, normals);
}

SurfaceMap LayerSource::map_surfaces(Recorder& recorder, const Frame& frame, const SceneTopology& topology,
                                     const MapProjection& projection) {
    Workspace& workspace = frame.workspace;
    const Device& device = workspace.device();
    const MapRecord record = record_of(projection);
    const std::uint64_t texels = texel_count(record);
    if (map_pool_.records == 0) {
        map_pool_.records = std::uint32_t(std::min<std::uint64_t>(4 * texels, most_map_items(device, kMapFoundSize)));
        map_pool_.tiles =
            std::uint32_t(std::min<std::uint64_t>(texels / 4 + 1024, most_map_items(device, kMapTileSize)));
    }
    const Buffer& maps = workspace.buffer("map projections", sizeof(MapRecord), true);
    std::memcpy(maps.mapped(), &record, sizeof(record));
    const auto buffer = [&](const char* name, vk::DeviceSize size, vk::Format format) {
        return &workspace.buffer(name, size, false, format);
    };
    const SurfaceMap map{&maps,
                         &triangle_buffer(frame, "map triangles"),
                         &triangle_buffer(frame, "map normals"),
                         buffer("map texels", texels * kMapTexelSize, kMapPairFormat),
                         buffer("map ranges", map_pool_.records * kMapRangeSize, kMapFormat),
                         buffer("map records", map_pool_.records * kMapRecordSize, kMapPairFormat),
                         buffer("map pyramid", node_count(record) * kMapNodeSize, kMapFormat),
                         nullptr};
    build_map(recorder, frame, topology,
              {map, record, 0, false, std::uint32_t(frame.scene.triangle_count), 0, map_pool_.records,
               map_pool_.records, map_pool_.tiles},
              counts_on_host(frame));
    mapped_ = true;
    return map;
}

bool LayerSource::must_enlarge_map(const Frame& frame) {
    if (!mapped_) return false;
    MapCount count{};
    std::memcpy(&count, counts_on_host(frame).mapped(), sizeof(count));
    const std::uint32_t records = std::max(count.records, count.placed);
    if (records <= map_pool_.records && count.tiles <= map_pool_.tiles) return false;
    const Device& device = frame.workspace.device();
    map_pool_.records = room_for(device, map_pool_.records, records, kMapFoundSize, "surfaces");
    map_pool_.tiles = room_for(device, map_pool_.tiles, count.tiles, kMapTileSize, "tiles of large triangles");
    return true;
}

}  // namespace pellucid
