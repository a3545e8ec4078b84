#include "layers/layer_images.h"

#include "layers/pixel_list.h"
#include "layers/shaders.h"

#include <array>

namespace pellucid {

LayerImages allocate_layers(const Frame& frame, const LayerRequest& request) {
    Workspace& workspace = frame.workspace;
    return {workspace.image(request.name + " depth", vk::Format::eR32Sfloat, frame.extent, request.count),
            workspace.image(request.name + " triangle", vk::Format::eR32Uint, frame.extent, request.count),
            workspace.image(request.name + " normal", vk::Format::eR32Uint, frame.extent, request.count)};
}

const Buffer& resolve_normals(Recorder& recorder, const Frame& frame, const LayerImages& images,
                              const LayerRequest& request) {
    const Buffer& covered = list_pixels(recorder, frame, images.triangle, PELLUCID_NO_TRIANGLE,
                                        request.name + " pixels", 0, frame.extent.height, frame.wanted_samples);
    const bool one_object = request.solids.size() == 1;
    recorder.compute_indirect(frame.workspace.compute(shaders::resolve_normals_comp, {{"kOneObject", one_object}}),
                              {frame.bindings(), reads("layer_triangle", images.triangle),
                               writes("layer_normal", images.normal), reads("PixelList", covered)},
                              std::array{request.count, one_object ? request.solids[0].object : 0u}, covered);
    return covered;
}

Layers finish_layers(Recorder& recorder, const Frame& frame, const LayerImages& images, const Opaque& opaque,
                     const LayerRequest& request, LayerSource& source) {
    const Buffer& covered = resolve_normals(recorder, frame, images, request);
    return {images.depth, images.triangle, images.normal, covered, request.count, opaque, source};
}

}  // namespace pellucid
