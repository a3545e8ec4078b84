#include "layers/back_faces.h"

#include "layers/layer_images.h"
#include "layers/shaders.h"

namespace pellucid {

BackFaces draw_back_faces(Recorder& recorder, const Frame& frame, std::span<const DrawCall> solids, BackFace which) {
    Workspace& workspace = frame.workspace;
    const Program& program = workspace.graphics({.vertex = shaders::layer_vert,
                                                 .fragment = shaders::back_faces_frag,
                                                 .colors = {vk::Format::eR32Sfloat, vk::Format::eR32Uint},
                                                 .depth = true});
    const LayerRequest request{solids, 1, false, "back face"};
    const LayerImages images = allocate_layers(frame, request);
    const GpuImage& nearest = workspace.image("back face depth test", vk::Format::eD32Sfloat, frame.extent);
    const RenderTarget target{.extent = frame.extent,
                              .colors = {{&images.depth, 0, clear_to(float(PELLUCID_EMPTY_DEPTH))},
                                         {&images.triangle, 0, clear_to({PELLUCID_NO_TRIANGLE, 0u, 0u, 0u})}},
                              .depth = RenderTarget::Attachment{&nearest, 0, clear_to_farthest()}};
    const Recorder::Scope scope(recorder, "back faces");
    recorder.draw(program, {frame.bindings()}, which == BackFace::kFarthest ? 1u : 0u, target, solids);
    resolve_normals(recorder, frame, images, request);
    return {images.depth, images.triangle, images.normal};
}

}  // namespace pellucid
