#include "layers/layer_images.h"

#include "layers/pixel_list.h"

namespace pellucid {
namespace {

constexpr std::uint32_t kResolveNormals[] = {
#include "resolve_normals.comp.inc"
};

}  // namespace

LayerImages allocate_layers(const Frame& frame, const LayerRequest& request) {
    Workspace& workspace = frame.workspace;
    return {workspace.image(request.name + " depth", vk::Format::eR32Sfloat, frame.extent, request.count),
            workspace.image(request.name + " triangle", vk::Format::eR32Uint, frame.extent, request.count),
            workspace.image(request.name + " normal", vk::Format::eR32Uint, frame.extent, request.count)};
}

const Buffer& resolve_normals(Recorder& recorder, const Frame& frame, const LayerImages& images, std::uint32_t count,
                              std::string_view list_name) {
    const Buffer& covered =
        list_pixels(recorder, frame, images.triangle, PELLUCID_NO_TRIANGLE, list_name, 0, frame.extent.height);
    recorder.compute_indirect(frame.workspace.compute({"resolve_normals.comp", kResolveNormals}),
                              {reads("Frame", frame.constants), reads("Objects", frame.scene.objects),
                               reads("Indices", frame.scene.indices), reads("Vertices", frame.scene.vertices),
                               reads("layer_triangle", images.triangle), writes("layer_normal", images.normal),
                               reads("PixelList", covered)},
                              count, covered);
    return covered;
}

Layers finish_layers(Recorder& recorder, const Frame& frame, const LayerImages& images, const Opaque& opaque,
                     const LayerRequest& request, LayerSource& source) {
    const Buffer& covered = resolve_normals(recorder, frame, images, request.count, request.name + " pixels");
    return {images.depth, images.triangle, images.normal, covered, request.count, opaque, source};
}

}  // namespace pellucid
