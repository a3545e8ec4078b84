// Triangles are rasterised in compute: what a fragment shader sees leaves out what covers no texel's centre.
#include "layers/surface_map.h"

#include "layers/layers.h"

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

constexpr std::uint32_t kGroup = 64;        // of the shaders that go through triangles
constexpr vk::DeviceSize kRecordSize = 16;  // SurfaceRecord
constexpr vk::DeviceSize kTileSize = 8;
constexpr vk::DeviceSize kNodeSize = 16;
constexpr vk::DeviceSize kTriangleSize = 48;

/// Twin of MapRecord in surface_map.glsl.
struct MapRecord {
    glm::mat4 map_from_space;
    glm::vec4 eye;
    float near_w;
    std::uint32_t width, height, log2_width, log2_height;
    std::uint32_t first_head, first_node, first_triangle;
};
static_assert(sizeof(MapRecord) == 112);

/// Twin of MapCount in map_count.glsl.
struct MapCount {
    std::uint32_t tiles;
    std::uint32_t records;
    std::uint32_t placed;
};

std::uint32_t log2_ceil(std::uint32_t size) { return std::uint32_t(std::bit_width(size - 1)); }

MapRecord record_of(const MapProjection& projection) {
    MapRecord record{};
    record.map_from_space = projection.map_from_world;
    record.eye = projection.eye;
    record.near_w = projection.near_w;
    record.width = projection.extent.width;
    record.height = projection.extent.height;
    record.log2_width = log2_ceil(record.width);
    record.log2_height = log2_ceil(record.height);
    return record;
}

const Buffer& counts_on_host(const Frame& frame) {
    return frame.workspace.buffer("map counts", sizeof(MapCount), true);
}

std::uint32_t largest(const Device& device, vk::DeviceSize item) {
    const vk::DeviceSize bytes = std::min<vk::DeviceSize>(device.max_storage_binding(), device.max_allocation());
    return std::uint32_t(
        std::min<vk::DeviceSize>(bytes / item, std::min(device.limits().maxTexelBufferElements, 0x7ffffffeu)));
}

}  // namespace

SurfaceMap LayerSource::map_surfaces(Recorder& recorder, const Frame& frame, const SceneTopology& topology,
                                     const MapProjection& projection) {
    Workspace& workspace = frame.workspace;
    const GpuScene& scene = frame.scene;
    const Device& device = workspace.device();
    const MapRecord record = record_of(projection);
    const std::uint64_t texels = 1ull << (record.log2_width + record.log2_height);
    if (map_pool_.records == 0) {
        map_pool_.records = std::uint32_t(std::min<std::uint64_t>(4 * texels, largest(device, kRecordSize)));
        map_pool_.tiles = std::uint32_t(std::min<std::uint64_t>(texels / 4 + 1024, largest(device, kTileSize)));
    }
    const Buffer& maps = workspace.buffer("map projections", sizeof(MapRecord), true);
    std::memcpy(maps.mapped(), &record, sizeof(record));

    const std::uint64_t nodes = 4 * texels / 3 + 1;
    const auto texel_buffer = [&](const char* name, vk::DeviceSize size) -> const Buffer& {
        return workspace.buffer(name, size, false, vk::Format::eR32G32B32A32Uint);
    };
    const SurfaceMap map{
        projection,
        &maps,
        &texel_buffer("map triangles", std::max<std::uint64_t>(scene.triangle_count, 1) * kTriangleSize),
        &workspace.buffer("map texels", texels * 2 * sizeof(std::uint32_t), false, vk::Format::eR32G32Uint),
        &texel_buffer("map records", map_pool_.records * kRecordSize),
        &texel_buffer("map pyramid", nodes * kNodeSize)};
    const Buffer& counters = workspace.buffer("map counters", sizeof(MapCount));
    const Buffer& found = texel_buffer("map records found", map_pool_.records * kRecordSize);
    const std::uint32_t one_object = scene.object_count == 1 ? 1 : 0;
    const Buffer& groups = workspace.buffer("map workgroups", 3 * sizeof(std::uint32_t));
    const Buffer& tiles = workspace.buffer("map tiles", map_pool_.tiles * kTileSize);

    recorder.fill(counters, 0);
    recorder.fill(*map.texels, 0);
    const std::uint32_t row_groups = device.limits().maxComputeWorkGroupCount[0];
    const std::uint64_t all_groups = (scene.triangle_count + kGroup - 1) / kGroup;
    const std::uint32_t rows = std::uint32_t(all_groups / row_groups + 1);
    const std::uint32_t row = std::uint32_t((all_groups + rows - 1) / rows) * kGroup;
    struct Push {
        std::uint32_t triangle_count, record_capacity, tile_capacity, row;
    };
    recorder.compute(workspace.compute({"rasterise_surfaces.comp", kRasteriseSurfaces}, {one_object}),
                     {reads("Frame", frame.constants), reads("Objects", scene.objects), reads("Indices", scene.indices),
                      reads("Vertices", scene.vertices), reads("Maps", maps), writes("MapTriangles", *map.triangles),
                      updates("MapCounters", counters), updates("Texels", *map.texels), writes("Found", found),
                      writes("Tiles", tiles)},
                     Push{std::uint32_t(scene.triangle_count), map_pool_.records, map_pool_.tiles, row}, {row, rows});
    const Program& dispatch = workspace.compute({"dispatch_map.comp", kDispatchMap});
    recorder.compute(dispatch, {updates("MapCounters", counters), writes("Groups", groups)},
                     std::array{0u, map_pool_.tiles, row_groups}, {1, 1});
    recorder.compute_indirect(
        workspace.compute({"rasterise_tiles.comp", kRasteriseTiles}),
        {reads("Maps", maps), reads("MapTriangles", *map.triangles), updates("MapCounters", counters),
         updates("Texels", *map.texels), writes("Found", found), reads("Tiles", tiles)},
        std::array{map_pool_.records, map_pool_.tiles}, groups);
    recorder.compute(workspace.compute({"place_texels.comp", kPlaceTexels}),
                     {reads("Maps", maps), updates("MapCounters", counters), updates("Texels", *map.texels)},
                     {std::uint32_t((texels + 15) / 16), 1});
    recorder.compute(dispatch, {updates("MapCounters", counters), writes("Groups", groups)},
                     std::array{1u, map_pool_.records, row_groups}, {1, 1});
    recorder.compute_indirect(workspace.compute({"place_records.comp", kPlaceRecords}, {one_object}),
                              {reads("Frame", frame.constants), reads("Objects", scene.objects),
                               reads("Traits", topology.traits), updates("MapCounters", counters),
                               reads("texels", *map.texels), reads("found", found), writes("Records", *map.records)},
                              map_pool_.records, groups);
    recorder.copy(counters, counts_on_host(frame), sizeof(MapCount));

    recorder.compute(workspace.compute({"summarise_texels.comp", kSummariseTexels}),
                     {reads("Maps", maps), reads("texels", *map.texels), reads("records", *map.records),
                      writes("Pyramid", *map.pyramid)},
                     {1u << record.log2_width, 1u << record.log2_height});
    for (std::uint32_t level = 1; level <= std::min(record.log2_width, record.log2_height); ++level) {
        recorder.compute(workspace.compute({"reduce_texels.comp", kReduceTexels}),
                         {reads("Maps", maps), updates("Pyramid", *map.pyramid)}, level,
                         {std::uint32_t(texels >> 2 * level), 1});
    }
    mapped_ = true;
    return map;
}

bool LayerSource::must_enlarge_map(const Frame& frame) {
    if (!mapped_) return false;
    MapCount count{};
    std::memcpy(&count, counts_on_host(frame).mapped(), sizeof(count));
    if (count.records <= map_pool_.records && count.tiles <= map_pool_.tiles) return false;
    const Device& device = frame.workspace.device();
    const auto enlarge = [&](std::uint32_t& room, std::uint32_t needed, vk::DeviceSize item, const char* what) {
        if (needed <= room) return;
        const std::uint32_t most = largest(device, item);
        if (needed > most) {
            throw Error(
                fmt::format("{} {} in the picture; {} has room for {}", needed, what, device.info().name, most));
        }
        room = std::uint32_t(std::min<std::uint64_t>(most, std::uint64_t(needed) + needed / 4));
    };
    enlarge(map_pool_.records, count.records, kRecordSize, "surfaces");
    enlarge(map_pool_.tiles, count.tiles, kTileSize, "tiles of large triangles");
    return true;
}

}  // namespace pellucid
