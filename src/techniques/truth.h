#pragma once

#include "techniques/technique.h"

#include <pellucid/reference.h>

namespace pellucid {

/// Input of a reference technique.
struct TracedView {
    const Tracer& tracer;
    Camera camera;
    glm::uvec2 picture;   ///< size of the whole image, pixels; a frame may draw a part of it
    glm::vec2 jitter_px;  ///< offset of the sample from the pixel's centre
    Progress progress;
};

/// Samples of an image.
struct PictureSamples {
    std::uint32_t count = 1;  ///< samples of every pixel
    /// instead of `count`, rows from the top; empty: `count` for each pixel
    std::vector<std::uint32_t> of_pixels = {};
    std::uint32_t first = 0;
    bool parts = false;  ///< PathTraceSettings::parts
};

/// Registry entry of a reference technique, against which techniques are measured. It has no passes: the CPU traces
/// exact paths (trace_exact_paths()), and frames shade them.
struct Truth {
    TechniqueInfo info;
    /// Traces the image itself, with all light. Null: the frames shade the exact paths.
    PathTracedImage (*trace_image)(const TracedView& view, const Environment& environment,
                                   const PictureSamples& samples, const ParameterValues& parameters) = nullptr;
};
/// The reference technique of `info`; null for other techniques.
const Truth* truth_of(const TechniqueInfo& info);

/// A parameter of all reference techniques.
inline constexpr ParameterInfo kMaxEvents{.name = "events",
                                          .unit = "",
                                          .default_value = 16,
                                          .minimum = 1,
                                          .maximum = 4095,
                                          .whole = true,
                                          .doc = "interface events that exact paths may have"};

/// Makes the host trace one exact path per pixel, up to kMaxEvents events, when the device reaches the frame. The
/// tracer must live until then.
Refraction trace_exact_paths(Recorder& recorder, const Frame& frame, const TracedView& view,
                             const ParameterValues& parameters);

/// Makes the host trace one sample of `truth`'s own image, for the whole image. RGBA32F. The tracer and `environment`
/// must live until then.
const GpuImage& trace_sample(Recorder& recorder, const Frame& frame, const Truth& truth, const TracedView& view,
                             const Environment& environment, std::uint32_t sample, const ParameterValues& parameters);

}  // namespace pellucid
