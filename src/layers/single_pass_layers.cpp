// One geometry pass builds per-pixel linked lists of fragments (Yang et al., "Real-Time Concurrent Linked List
// Construction on the GPU", EGSR 2010). A compute pass selects the nearest fragments of each list. Triangles are drawn,
// which needs Device::fragment_atomics(), or rasterised in compute shaders.
#include "layers/layer_images.h"
#include "layers/map_building.h"
#include "layers/pixel_list.h"
#include "layers/shaders.h"

#include <algorithm>
#include <array>

namespace pellucid {
namespace {

constexpr float kRasterisedDepthRounding = 2e-6f;  ///< relative rounding of depths

bool mirrors(const glm::mat4& transform) { return glm::determinant(glm::mat3(transform)) < 0.0f; }

}  // namespace

/// A band of the image: its fragment lists and its rows.
struct LayerSource::FragmentBand {
    const GpuImage& heads;
    const Buffer& nodes;
    std::uint32_t first_row, row_end;
};

void LayerSource::rasterise_fragments(Recorder& recorder, const Frame& frame, const LayerRequest& request,
                                      const FragmentBand& band) {
    Workspace& workspace = frame.workspace;
    const GpuScene& scene = frame.scene;
    CountedBuffer& counted_tiles = counted("fragment tiles", kMapTileSize);
    const Buffer& tiles =
        counted_tiles.begin(recorder, workspace, frame.extent.width * frame.extent.height / 16 + 1024);
    struct Push {
        glm::mat4 world_from_object;
        std::uint32_t first_triangle, first_corner, mirrored, reserved;
        std::uint32_t triangle_count, row, first_row, row_end;
    };
    for (const DrawCall& solid : request.solids) {
        const std::uint32_t triangles = solid.corner_count / 3;
        const vk::Extent2D threads = threads_for(workspace.device(), triangles);
        recorder.compute(
            workspace.compute(shaders::rasterise_fragments_comp),
            {frame.bindings(), updates("Nodes", band.nodes), updates("heads", band.heads), updates("Tiles", tiles)},
            Push{scene.world_from_object[solid.object], scene.first_triangles[solid.object], solid.first_corner,
                 mirrors(scene.world_from_object[solid.object]) ? 1u : 0u, 0, triangles, threads.width, band.first_row,
                 band.row_end},
            threads);
    }
    recorder.compute_indirect(
        workspace.compute(shaders::rasterise_fragment_tiles_comp),
        {frame.bindings(), updates("Nodes", band.nodes), updates("heads", band.heads), reads("Tiles", tiles)},
        std::array{band.first_row, band.row_end}, counted_tiles.groups(recorder, workspace));
    counted_tiles.end(recorder);
}

Layers LayerSource::gather(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request) {
    bands_ = std::min(bands_, frame.extent.height);
    CountedBuffer& fragments = counted("fragments", kFragmentNodeSize);
    Workspace& workspace = frame.workspace;
    const bool in_compute = builder_ == LayerBuilder::kCompute;
    const bool one_object = request.solids.size() == 1;
    const Program& select = workspace.compute(shaders::select_layers_comp, {{"kOneObject", one_object}});
    const LayerImages images = allocate_layers(frame, request);
    const GpuImage& heads = workspace.image("fragment list heads", vk::Format::eR32Uint, frame.extent);
    const std::string list_name = request.name + " pixels";
    struct SelectPush {
        std::uint32_t layer_count, hidden_by_opaque, only_object;
        float depth_rounding;
    };

    recorder.clear(heads, vk::ClearColorValue(std::array{0u, 0u, 0u, 0u}));
    recorder.clear(images.depth, vk::ClearColorValue(std::array{float(PELLUCID_EMPTY_DEPTH), 0.0f, 0.0f, 0.0f}));
    recorder.clear(images.triangle, vk::ClearColorValue(std::array{PELLUCID_NO_TRIANGLE, 0u, 0u, 0u}));
    const std::uint32_t band_rows = (frame.extent.height + bands_ - 1) / bands_;
    const Buffer* listed = nullptr;
    for (std::uint32_t band = 0; band < bands_; ++band) {
        const std::uint32_t first_row = std::min(band * band_rows, frame.extent.height);
        const std::uint32_t rows = std::min(band_rows, frame.extent.height - first_row);
        if (rows == 0) break;
        ++geometry_passes_;
        // The initial capacity is two surfaces per pixel.
        const Buffer& nodes = fragments.begin(recorder, workspace, 2ull * frame.extent.width * frame.extent.height);
        if (in_compute) {
            rasterise_fragments(recorder, frame, request, {heads, nodes, first_row, first_row + rows});
        } else {
            const Program& gather =
                workspace.graphics({.vertex = shaders::layer_vert, .fragment = shaders::gather_fragments_frag});
            const RenderTarget target{.extent = frame.extent,
                                      .scissor = {{0, std::int32_t(first_row)}, {frame.extent.width, rows}}};
            recorder.draw(gather, {frame.bindings(), updates("Nodes", nodes), updates("heads", heads)}, target,
                          request.solids);
        }
        fragments.end(recorder);
        listed = &list_pixels(recorder, frame, heads, 0, list_name, first_row, first_row + rows, frame.wanted_samples);
        recorder.compute_indirect(
            select,
            {frame.bindings(), reads("PixelList", *listed), reads("Nodes", nodes), reads("heads", heads),
             reads("opaque_depth", opaque.depth), writes("layer_depth", images.depth),
             writes("layer_triangle", images.triangle), writes("layer_normal", images.normal)},
            SelectPush{request.count, request.hidden_by_opaque ? 1u : 0u, one_object ? request.solids[0].object : 0u,
                       in_compute ? kRasterisedDepthRounding : 0.0f},
            *listed);
    }
    // The list of the last band covers the image only if there is one band and no opaque surface hides layers.
    if (bands_ > 1 || (request.hidden_by_opaque && frame.has_opaque())) {
        listed = &list_pixels(recorder, frame, images.triangle, PELLUCID_NO_TRIANGLE, list_name, 0, frame.extent.height,
                              frame.wanted_samples);
    }
    return {images.depth, images.triangle, images.normal, *listed, request.count, opaque, *this};
}

// Divides the image into more bands if the fragments of a band exceed the largest buffer.
void LayerSource::cut_bands(const Frame& frame) {
    CountedBuffer& fragments = counted("fragments", kFragmentNodeSize);
    const std::uint32_t most = fragments.limit(frame.workspace.device());
    if (fragments.capacity() <= most || bands_ >= frame.extent.height) return;
    const std::uint64_t bands = std::uint64_t(bands_) * (fragments.capacity() / most + 1);
    bands_ = std::uint32_t(std::min<std::uint64_t>(bands, frame.extent.height));
    fragments.set_capacity(most);
}

}  // namespace pellucid
