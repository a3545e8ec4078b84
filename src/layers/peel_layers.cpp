// Depth peeling, one geometry pass per layer: Everitt, "Interactive Order-Independent Transparency", NVIDIA 2001.
#include "layers/layer_images.h"
#include "layers/shaders.h"

#include <array>

namespace pellucid {

Layers LayerSource::peel(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request) {
    Workspace& workspace = frame.workspace;
    const Program& program = workspace.graphics({.vertex = shaders::layer_vert,
                                                 .fragment = shaders::peel_layers_frag,
                                                 .colors = {vk::Format::eR32Sfloat, vk::Format::eR32Uint},
                                                 .depth = true});
    const LayerImages images = allocate_layers(frame, request);
    const GpuImage& nearest = workspace.image("peel depth test", vk::Format::eD32Sfloat, frame.extent);
    // The first layer reads no previous layer, but an image of the right kind has to be bound.
    const GpuImage& no_triangle = workspace.image("no triangle", vk::Format::eR32Uint, {1, 1});

    for (std::uint32_t layer = 0; layer < request.count; ++layer) {
        const std::uint32_t last = layer > 0 ? layer - 1 : 0;
        const RenderTarget target{.extent = frame.extent,
                                  .colors = {{&images.depth, layer, clear_to(float(PELLUCID_EMPTY_DEPTH))},
                                             {&images.triangle, layer, clear_to({PELLUCID_NO_TRIANGLE, 0u, 0u, 0u})}},
                                  .depth = RenderTarget::Attachment{&nearest, 0, clear_to_farthest()}};
        recorder.draw(program,
                      {frame.bindings(), reads("opaque_depth", opaque.depth),
                       reads_layer("last_depth", layer > 0 ? images.depth : opaque.depth, last),
                       reads_layer("last_triangle", layer > 0 ? images.triangle : no_triangle, last)},
                      std::array{layer, request.hidden_by_opaque ? 1u : 0u}, target, request.solids);
    }
    geometry_passes_ += request.count;
    return finish_layers(recorder, frame, images, opaque, request, *this);
}

}  // namespace pellucid
