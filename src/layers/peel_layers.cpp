#include "layers/layers.h"

#include <array>

namespace pellucid {
namespace {

constexpr std::uint32_t kLayerVertex[] = {
#include "layer.vert.inc"
};
constexpr std::uint32_t kPeelLayersFragment[] = {
#include "peel_layers.frag.inc"
};

}  // namespace

Layers peel_layers(Recorder& recorder, const Frame& frame, std::uint32_t count, const GpuImage& opaque_depth) {
    Workspace& workspace = frame.workspace;
    const Program& program = workspace.graphics({.vertex = {"layer.vert", kLayerVertex},
                                                 .fragment = {"peel_layers.frag", kPeelLayersFragment},
                                                 .stream_strides = stream_strides(false),
                                                 .attributes = vertex_attributes(false),
                                                 .colors = {vk::Format::eR32Sfloat, vk::Format::eR32G32Uint},
                                                 .depth = true});
    const GpuImage& depth = workspace.image("layer depth", vk::Format::eR32Sfloat, frame.extent, count);
    const GpuImage& surface = workspace.image("layer surface", vk::Format::eR32G32Uint, frame.extent, count);
    const GpuImage& nearest = workspace.image("peel depth test", vk::Format::eD32Sfloat, frame.extent);
    // Before the first layer there is none to read; something of the right kind has to be bound.
    const GpuImage& no_surface = workspace.image("no surface", vk::Format::eR32G32Uint, {1, 1});

    const Recorder::Scope scope(recorder, "layers");
    const vk::ClearValue no_depth = clear_to(float(PELLUCID_EMPTY_DEPTH));
    const vk::ClearValue no_triangle = clear_to({0u, PELLUCID_NO_TRIANGLE, 0u, 0u});
    const std::array<const Buffer*, 1> streams = {&frame.scene.geometry};
    for (std::uint32_t layer = 0; layer < count; ++layer) {
        const std::uint32_t last = layer > 0 ? layer - 1 : 0;
        const RenderTarget target{.extent = frame.extent,
                                  .colors = {{&depth, layer, no_depth}, {&surface, layer, no_triangle}},
                                  .depth = RenderTarget::Attachment{&nearest, 0, clear_to_farthest()},
                                  .scissor = {}};
        recorder.draw(
            program,
            {reads("Frame", frame.constants), reads("Objects", frame.scene.objects),
             reads("opaque_depth", opaque_depth), reads_layer("last_depth", layer > 0 ? depth : opaque_depth, last),
             reads_layer("last_surface", layer > 0 ? surface : no_surface, last)},
            layer, target, streams, frame.scene.refractive);
    }
    return {depth, surface, count};
}

}  // namespace pellucid
