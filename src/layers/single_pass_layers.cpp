// One geometry pass for all layers: per-pixel linked lists (Yang et al., "Real-Time Concurrent Linked List
// Construction on the GPU", EGSR 2010), of which a compute pass selects the nearest. Triangles are drawn, which needs
// Device::fragment_atomics(), or rasterised in compute shaders.
#include "layers/layer_images.h"
#include "layers/map_building.h"
#include "layers/pixel_list.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace pellucid {
namespace {

constexpr std::uint32_t kLayerVertex[] = {
#include "layer.vert.inc"
};
constexpr std::uint32_t kGatherFragmentsFragment[] = {
#include "gather_fragments.frag.inc"
};
constexpr std::uint32_t kRasteriseFragments[] = {
#include "rasterise_fragments.comp.inc"
};
constexpr std::uint32_t kRasteriseFragmentTiles[] = {
#include "rasterise_fragment_tiles.comp.inc"
};
constexpr std::uint32_t kDispatchMap[] = {
#include "dispatch_map.comp.inc"
};
constexpr std::uint32_t kSelectLayersCompute[] = {
#include "select_layers.comp.inc"
};

constexpr vk::DeviceSize kNodeSize = 12;
constexpr float kRasterisedDepthRounding = 2e-6f;  ///< of depths, relative

bool mirrors(const glm::mat4& transform) { return glm::determinant(glm::mat3(transform)) < 0.0f; }

std::uint32_t largest_pool(const Device& device) {
    const vk::DeviceSize bytes = std::min<vk::DeviceSize>(device.max_storage_binding(), device.max_allocation());
    return std::uint32_t(std::min<vk::DeviceSize>(bytes / kNodeSize, 0xfffffffeu));
}

/// Before anything is measured: two surfaces in every pixel.
std::uint32_t first_guess(const Frame& frame) {
    const std::uint64_t fragments = 2ull * frame.extent.width * frame.extent.height;
    return std::uint32_t(std::clamp<std::uint64_t>(fragments, 1024, largest_pool(frame.workspace.device())));
}

/// Fragments per band of each build of a frame. A camera's frame builds all solids of glass together, and each of them
/// alone at most.
vk::DeviceSize counter_bytes(const Frame& frame, const FragmentPool& pool) {
    const std::size_t builds = std::max<std::size_t>(frame.scene.refractive.size() + 1, pool.builds);
    return vk::DeviceSize(builds) * pool.bands * sizeof(std::uint32_t);
}

const Buffer& counters_on_host(const Frame& frame, const FragmentPool& pool) {
    return frame.workspace.buffer("fragment counts", counter_bytes(frame, pool), true);
}

const Buffer& tile_counts_on_host(const Frame& frame, const FragmentPool& pool) {
    const vk::DeviceSize counters = counter_bytes(frame, pool) / sizeof(std::uint32_t);
    return frame.workspace.buffer("counted fragment tiles", counters * sizeof(MapCount), true);
}

}  // namespace

/// Where the fragments of a band go, and its rows.
struct LayerSource::FragmentBand {
    const GpuImage& heads;
    const Buffer &nodes, &counters;
    std::uint32_t counter;  ///< among the counters
    std::uint32_t first_row, row_end;
};

void LayerSource::rasterise_fragments(Recorder& recorder, const Frame& frame, const LayerRequest& request,
                                      const FragmentBand& band) {
    constexpr std::uint32_t kGroup = 64;
    Workspace& workspace = frame.workspace;
    const GpuScene& scene = frame.scene;
    if (tile_capacity_ == 0) tile_capacity_ = frame.extent.width * frame.extent.height / 16 + 1024;
    const Buffer& counts = workspace.buffer("fragment tile counts", sizeof(MapCount));
    const Buffer& tiles = workspace.buffer("fragment tiles", tile_capacity_ * kMapTileSize);
    const Buffer& groups = workspace.buffer("fragment tile groups", 3 * sizeof(std::uint32_t));
    const std::uint32_t row_groups = workspace.device().limits().maxComputeWorkGroupCount[0];
    struct Push {
        glm::mat4 world_from_object;
        std::uint32_t first_triangle, first_corner, mirrored, reserved;
        std::uint32_t triangle_count, row, counter, capacity, tile_capacity, first_row, row_end;
    };
    recorder.fill(counts, 0);
    for (const DrawCall& solid : request.solids) {
        const std::uint32_t triangles = solid.corner_count / 3, all_groups = (triangles + kGroup - 1) / kGroup;
        const std::uint32_t rows = all_groups / row_groups + 1, row = (all_groups + rows - 1) / rows * kGroup;
        recorder.compute(
            workspace.compute({"rasterise_fragments.comp", kRasteriseFragments}),
            {reads("Frame", frame.constants), reads("Indices", scene.indices), reads("Vertices", scene.vertices),
             updates("Counters", band.counters), writes("Nodes", band.nodes), updates("heads", band.heads),
             updates("MapCounters", counts), writes("Tiles", tiles)},
            Push{scene.world_from_object[solid.object], scene.first_triangles[solid.object], solid.first_corner,
                 mirrors(scene.world_from_object[solid.object]) ? 1u : 0u, 0, triangles, row, band.counter,
                 pool_.capacity, tile_capacity_, band.first_row, band.row_end},
            {row, rows});
    }
    recorder.compute(workspace.compute({"dispatch_map.comp", kDispatchMap}),
                     {updates("MapCounters", counts), writes("Groups", groups)},
                     std::array{0u, tile_capacity_, row_groups}, {1, 1});
    recorder.compute_indirect(
        workspace.compute({"rasterise_fragment_tiles.comp", kRasteriseFragmentTiles}),
        {reads("Frame", frame.constants), reads("Objects", scene.objects), reads("Indices", scene.indices),
         reads("Vertices", scene.vertices), updates("Counters", band.counters), writes("Nodes", band.nodes),
         updates("heads", band.heads), updates("MapCounters", counts), reads("Tiles", tiles)},
        std::array{band.counter, pool_.capacity, tile_capacity_, band.first_row, band.row_end}, groups);
    recorder.copy(counts, tile_counts_on_host(frame, pool_), sizeof(MapCount), band.counter * sizeof(MapCount));
}

Layers LayerSource::gather(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request) {
    if (pool_.capacity == 0) pool_.capacity = first_guess(frame);
    pool_.bands = std::min(pool_.bands, frame.extent.height);
    Workspace& workspace = frame.workspace;
    const bool in_compute = builder_ == LayerBuilder::kCompute;
    const bool one_object = request.solids.size() == 1;
    const Program& select = workspace.compute({"select_layers.comp", kSelectLayersCompute}, {one_object ? 1u : 0u});
    const LayerImages images = allocate_layers(frame, request);
    const GpuImage& heads = workspace.image("fragment list heads", vk::Format::eR32Uint, frame.extent);
    const Buffer& nodes = workspace.buffer("fragments", pool_.capacity * kNodeSize);
    const Buffer& counters = workspace.buffer("fragment counters", counter_bytes(frame, pool_));
    const std::string list_name = request.name + " pixels";
    struct SelectPush {
        std::uint32_t layer_count, hidden_by_opaque, only_object;
        float depth_rounding;
    };

    recorder.clear(heads, vk::ClearColorValue(std::array{0u, 0u, 0u, 0u}));
    recorder.clear(images.depth, vk::ClearColorValue(std::array{float(PELLUCID_EMPTY_DEPTH), 0.0f, 0.0f, 0.0f}));
    recorder.clear(images.triangle, vk::ClearColorValue(std::array{PELLUCID_NO_TRIANGLE, 0u, 0u, 0u}));
    if (builds_ == 0) recorder.fill(counters, 0);
    const std::uint32_t band_rows = (frame.extent.height + pool_.bands - 1) / pool_.bands;
    const Buffer* listed = nullptr;
    for (std::uint32_t band = 0; band < pool_.bands; ++band) {
        const std::uint32_t first_row = std::min(band * band_rows, frame.extent.height);
        const std::uint32_t rows = std::min(band_rows, frame.extent.height - first_row);
        if (rows == 0) break;
        ++geometry_passes_;
        const FragmentBand to{heads, nodes, counters, builds_ * pool_.bands + band, first_row, first_row + rows};
        if (in_compute) {
            rasterise_fragments(recorder, frame, request, to);
        } else {
            const Program& gather = workspace.graphics({.vertex = {"layer.vert", kLayerVertex},
                                                        .fragment = {"gather_fragments.frag", kGatherFragmentsFragment},
                                                        .colors = {}});
            const RenderTarget target{.extent = frame.extent,
                                      .colors = {},
                                      .depth = {},
                                      .scissor = {{0, std::int32_t(first_row)}, {frame.extent.width, rows}}};
            recorder.draw(gather,
                          {reads("Frame", frame.constants), reads("Objects", frame.scene.objects),
                           reads("Indices", frame.scene.indices), reads("Vertices", frame.scene.vertices),
                           updates("Counters", counters), writes("Nodes", nodes), updates("heads", heads)},
                          std::array{to.counter, pool_.capacity}, target, request.solids);
        }
        listed = &list_pixels(recorder, frame, heads, 0, list_name, first_row, first_row + rows, frame.wanted_samples);
        recorder.compute_indirect(
            select,
            {reads("Frame", frame.constants), reads("Objects", frame.scene.objects),
             reads("Indices", frame.scene.indices), reads("Vertices", frame.scene.vertices),
             reads("PixelList", *listed), reads("Nodes", nodes), reads("heads", heads),
             reads("opaque_depth", opaque.depth), writes("layer_depth", images.depth),
             writes("layer_triangle", images.triangle), writes("layer_normal", images.normal)},
            SelectPush{request.count, request.hidden_by_opaque ? 1u : 0u, one_object ? request.solids[0].object : 0u,
                       in_compute ? kRasterisedDepthRounding : 0.0f},
            *listed);
    }
    ++builds_;
    recorder.copy(counters, counters_on_host(frame, pool_), counters.size());
    // The list of the last band is that of the picture only if there is one band and nothing opaque.
    if (pool_.bands > 1 || (request.hidden_by_opaque && !frame.scene.opaque.empty())) {
        listed = &list_pixels(recorder, frame, images.triangle, PELLUCID_NO_TRIANGLE, list_name, 0, frame.extent.height,
                              frame.wanted_samples);
    }
    return {images.depth, images.triangle, images.normal, *listed, request.count, opaque, *this};
}

bool LayerSource::must_enlarge_tiles(const Frame& frame) {
    std::uint32_t needed = 0;
    for (std::uint32_t i = 0; i < builds_ * pool_.bands; ++i) {
        MapCount count{};
        std::memcpy(&count, tile_counts_on_host(frame, pool_).mapped() + i * sizeof(count), sizeof(count));
        needed = std::max(needed, count.tiles);
    }
    if (needed <= tile_capacity_) return false;
    tile_capacity_ =
        room_for(frame.workspace.device(), tile_capacity_, needed, kMapTileSize, "tiles of large triangles");
    return true;
}

bool LayerSource::must_enlarge_pool(const Frame& frame) {
    if (builds_ == 0) return false;
    // Before the bands change, by which both are counted; tiles that were left out have no fragments yet.
    if (builder_ == LayerBuilder::kCompute && must_enlarge_tiles(frame)) return true;
    const Buffer& counters = counters_on_host(frame, pool_);
    std::uint32_t needed = 0;
    for (std::uint32_t i = 0; i < builds_ * pool_.bands; ++i) {
        std::uint32_t fragments = 0;
        std::memcpy(&fragments, counters.mapped() + i * sizeof(fragments), sizeof(fragments));
        needed = std::max(needed, fragments);
    }
    if (needed <= pool_.capacity) return false;

    const std::uint32_t largest = largest_pool(frame.workspace.device());
    if (needed <= largest) {
        pool_.capacity = std::uint32_t(std::min<std::uint64_t>(largest, std::uint64_t(needed) + needed / 4));
    } else if (pool_.bands < frame.extent.height) {
        pool_.capacity = largest;
        const std::uint64_t wanted = std::uint64_t(pool_.bands) * (std::uint64_t(needed) / largest + 1);
        pool_.bands = std::uint32_t(std::min<std::uint64_t>(wanted, frame.extent.height));
    } else {
        throw TooLarge(fmt::format("{} glass surfaces in one row of pixels; {} has room for {}", needed,
                                   frame.workspace.device().info().name, largest));
    }
    return true;
}

}  // namespace pellucid
