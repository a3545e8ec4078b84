#pragma once

#include "shade/shade.h"
#include "shade/transmitted_light.h"
#include "techniques/irradiance/irradiance_cache.h"
#include "techniques/photons/photons.h"
#include "techniques/truth.h"

namespace pellucid {

/// The caller's choices for a frame.
struct FrameSettings {
    const TechniqueInfo& info;
    const Technique* technique;  ///< null for a reference technique
    const Truth* truth;          ///< null for other techniques
    ParameterValues parameters;
    const Technique* caustics = nullptr;  ///< finds the exits of photons from glass; null: photons follow paths
    LayerBuilder layer_builder;
    View view;
    std::uint32_t photons = 0;  ///< photons per source and frame
};

/// Images of a frame on the device.
struct FrameImages {
    Layers layers;
    Refraction refraction;
    const GpuImage& radiance;  ///< RGBA32F, scene-linear
};

/// Records one frame: the whole renderer in a few lines. Record again if must_repeat() of `source` or `transmitted` is
/// true. `traced`: for reference techniques.
FrameImages record_frame(Recorder& recorder, const Frame& frame, const FrameSettings& settings, LayerSource& source,
                         TransmittedLight& transmitted, const TracedView* traced);

}  // namespace pellucid
