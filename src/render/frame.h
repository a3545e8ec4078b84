#pragma once

#include "shade/shade.h"
#include "shade/transmitted_light.h"
#include "techniques/irradiance/irradiance_cache.h"
#include "techniques/photons/photons.h"
#include "techniques/truth.h"

namespace pellucid {

/// What the caller chose for a frame.
struct FrameSettings {
    const TechniqueInfo& info;
    const Technique* technique;  ///< null for a truth
    const Truth* truth;          ///< null for a technique
    ParameterValues parameters;
    const Technique* caustics = nullptr;  ///< finds where photons leave glass; null: paths do
    LayerBuilder layer_builder;
    View view;
    std::uint32_t photons = 0;  ///< of every source in every frame
};

/// What a frame leaves behind on the device.
struct FrameImages {
    Layers layers;
    Refraction refraction;
    const GpuImage& radiance;  ///< RGBA32F, scene-linear
};

/// Records one frame: the whole renderer in a few lines. To be recorded again if `source` or `transmitted` must_repeat().
/// `traced`: for truths.
FrameImages record_frame(Recorder& recorder, const Frame& frame, const FrameSettings& settings, LayerSource& source,
                         TransmittedLight& transmitted, const TracedView* traced);

}  // namespace pellucid
