#include "render/frame.h"

namespace pellucid {
namespace {

Layers build_layers(Recorder& recorder, const Frame& frame, const FrameSettings& settings, const Opaque& opaque,
                    FragmentPool& pool) {
    const std::uint32_t count = settings.technique.layer_count(settings.parameters);
    return settings.layer_builder == LayerBuilder::kSinglePass
               ? single_pass_layers(recorder, frame, count, opaque.depth, pool)
               : peel_layers(recorder, frame, count, opaque.depth);
}

}  // namespace

FrameImages record_frame(Recorder& recorder, const Frame& frame, const FrameSettings& settings, FragmentPool& pool) {
    const Opaque opaque = draw_opaque(recorder, frame);
    const Layers layers = build_layers(recorder, frame, settings, opaque, pool);
    const Refraction refraction = settings.technique.record(recorder, frame, layers, settings.parameters);
    const SurfaceLook look = draw_surface_look(recorder, frame, opaque, layers);
    const GpuImage& radiance = shade(recorder, frame, opaque, layers, look, refraction, settings.view);
    return {layers, refraction, radiance};
}

}  // namespace pellucid
