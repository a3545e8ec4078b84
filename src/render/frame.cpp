#include "render/frame.h"

#include "techniques/visibility_layers/visibility_layers.h"

namespace pellucid {
FrameImages record_frame(Recorder& recorder, const Frame& frame, const FrameSettings& settings, LayerSource& source,
                         TransmittedLight& transmitted, const TracedView* traced) {
    const std::uint32_t layer_count = settings.technique ? settings.technique->layer_count(settings.parameters) : 1;
    source.begin_frame(settings.layer_builder);
    const Opaque opaque = draw_opaque(recorder, frame);
    transmitted.add(recorder, frame, opaque);
    const Layers layers = source.build(recorder, frame, opaque, {frame.scene.refractive, layer_count});
    if (settings.technique && !settings.technique->info.whole_scene && frame.light.any() && !frame.scene.opaque.empty())
        light_surfaces(recorder, frame, layers);
    const Refraction refraction = settings.truth
                                      ? trace_exact_paths(recorder, frame, *traced, settings.parameters)
                                      : settings.technique->record(recorder, frame, layers, settings.parameters);
    const ThinWalls walls = draw_thin_walls(recorder, frame, opaque, layers);
    const GpuImage& radiance = shade(recorder, frame, opaque, layers, walls, refraction, settings.view);
    if (frame.front_exposure) settings.technique->draw_light(recorder, frame, opaque, radiance);
    return {layers, refraction, radiance};
}

}  // namespace pellucid
