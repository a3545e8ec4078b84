#pragma once

#include "shade/shade.h"
#include "shade/transmitted_light.h"
#include "techniques/technique.h"

namespace pellucid {

/// What the caller chose for a frame.
struct FrameSettings {
    const Technique& technique;
    ParameterValues parameters;
    LayerBuilder layer_builder;
    View view;
};

/// What a frame leaves behind on the device.
struct FrameImages {
    Layers layers;
    Refraction refraction;
    const GpuImage& radiance;  ///< RGBA32F, scene-linear
};

/// Records one frame: the whole renderer in six lines. To be recorded again if `source` or `transmitted` must_repeat().
FrameImages record_frame(Recorder& recorder, const Frame& frame, const FrameSettings& settings, LayerSource& source,
                         TransmittedLight& transmitted);

}  // namespace pellucid
