#include "layers/layers.h"

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
constexpr std::uint32_t kSelectLayersCompute[] = {
#include "select_layers.comp.inc"
};

constexpr vk::DeviceSize kNodeSize = 16;

std::uint32_t largest_pool(const Device& device) {
    const vk::DeviceSize bytes = std::min<vk::DeviceSize>(device.max_storage_binding(), device.max_allocation());
    return std::uint32_t(std::min<vk::DeviceSize>(bytes / kNodeSize, 0xfffffffeu));
}

/// Before anything is measured: two surfaces in every pixel.
std::uint32_t first_guess(const Frame& frame) {
    const std::uint64_t fragments = 2ull * frame.extent.width * frame.extent.height;
    return std::uint32_t(std::clamp<std::uint64_t>(fragments, 1024, largest_pool(frame.workspace.device())));
}

const Buffer& counters_on_host(const Frame& frame, const FragmentPool& pool) {
    return frame.workspace.buffer("fragment counts", pool.bands * sizeof(std::uint32_t), true);
}

}  // namespace

Layers single_pass_layers(Recorder& recorder, const Frame& frame, std::uint32_t count, const GpuImage& opaque_depth,
                          FragmentPool& pool) {
    if (pool.capacity == 0) pool.capacity = first_guess(frame);
    pool.bands = std::min(pool.bands, frame.extent.height);
    Workspace& workspace = frame.workspace;
    const Program& gather = workspace.graphics({.vertex = {"layer.vert", kLayerVertex},
                                                .fragment = {"gather_fragments.frag", kGatherFragmentsFragment},
                                                .stream_strides = stream_strides(false),
                                                .attributes = vertex_attributes(false),
                                                .colors = {}});
    const Program& select = workspace.compute({"select_layers.comp", kSelectLayersCompute});
    const GpuImage& depth = workspace.image("layer depth", vk::Format::eR32Sfloat, frame.extent, count);
    const GpuImage& surface = workspace.image("layer surface", vk::Format::eR32G32Uint, frame.extent, count);
    const GpuImage& heads = workspace.image("fragment list heads", vk::Format::eR32Uint, frame.extent);
    const Buffer& nodes = workspace.buffer("fragments", pool.capacity * kNodeSize);
    const Buffer& counters = workspace.buffer("fragment counters", pool.bands * sizeof(std::uint32_t));
    const Buffer& host_counters = counters_on_host(frame, pool);
    const std::array<const Buffer*, 1> streams = {&frame.scene.geometry};

    const Recorder::Scope scope(recorder, "layers");
    recorder.clear(heads, vk::ClearColorValue(std::array{0u, 0u, 0u, 0u}));
    recorder.fill(counters, 0);
    const std::uint32_t band_rows = (frame.extent.height + pool.bands - 1) / pool.bands;
    for (std::uint32_t band = 0; band < pool.bands; ++band) {
        const std::uint32_t first_row = std::min(band * band_rows, frame.extent.height);
        const std::uint32_t rows = std::min(band_rows, frame.extent.height - first_row);
        if (rows == 0) break;
        const RenderTarget target{.extent = frame.extent,
                                  .colors = {},
                                  .depth = {},
                                  .scissor = {{0, std::int32_t(first_row)}, {frame.extent.width, rows}}};
        recorder.draw(gather,
                      {reads("Frame", frame.constants), reads("Objects", frame.scene.objects),
                       updates("Counters", counters), writes("Nodes", nodes), updates("heads", heads)},
                      std::array{band, pool.capacity}, target, streams, frame.scene.refractive);
        recorder.compute(select,
                         {reads("Nodes", nodes), reads("heads", heads), reads("opaque_depth", opaque_depth),
                          writes("layer_depth", depth), writes("layer_surface", surface)},
                         std::array{first_row, first_row + rows, count}, {frame.extent.width, rows});
    }
    recorder.copy(counters, host_counters, counters.size());
    return {depth, surface, count};
}

bool fragment_pool_overflowed(const Frame& frame, FragmentPool& pool) {
    const Buffer& counters = counters_on_host(frame, pool);
    std::uint32_t needed = 0;
    for (std::uint32_t band = 0; band < pool.bands; ++band) {
        std::uint32_t fragments = 0;
        std::memcpy(&fragments, counters.mapped() + band * sizeof(fragments), sizeof(fragments));
        needed = std::max(needed, fragments);
    }
    if (needed <= pool.capacity) return false;

    const std::uint32_t largest = largest_pool(frame.workspace.device());
    if (needed <= largest) {
        pool.capacity = std::uint32_t(std::min<std::uint64_t>(largest, std::uint64_t(needed) + needed / 4));
    } else if (pool.bands < frame.extent.height) {
        pool.capacity = largest;
        const std::uint64_t wanted = std::uint64_t(pool.bands) * (std::uint64_t(needed) / largest + 1);
        pool.bands = std::uint32_t(std::min<std::uint64_t>(wanted, frame.extent.height));
    } else {
        throw Error(fmt::format("{} glass surfaces in one row of pixels; {} has room for {}", needed,
                                frame.workspace.device().info().name, largest));
    }
    return true;
}

}  // namespace pellucid
