#pragma once

#include "techniques/technique.h"

#include <pellucid/reference.h>

namespace pellucid {

/// What a truth looks at.
struct TracedView {
    const Tracer& tracer;
    Camera camera;
    glm::uvec2 picture;   ///< pixels, of which a frame may draw a part
    glm::vec2 jitter_px;  ///< of the sample within the pixel, from its centre
    Progress progress;
};

/// Which samples a picture has.
struct PictureSamples {
    std::uint32_t count = 1;                    ///< of every pixel
    std::vector<std::uint32_t> of_pixels = {};  ///< in place of `count`, rows from the top; empty: all alike
    std::uint32_t first = 0;
    bool parts = false;  ///< PathTraceSettings::parts
};

/// A row of the registry for what techniques are measured against. It has no passes: the CPU traces its exact paths
/// (trace_exact_paths()), and frames shade them.
struct Truth {
    TechniqueInfo info;
    /// The image that it traces itself, of all light. Null: its image is the frames'.
    PathTracedImage (*trace_image)(const TracedView& view, const Environment& environment,
                                   const PictureSamples& samples, const ParameterValues& parameters) = nullptr;
};
/// Null for a technique.
const Truth* truth_of(const TechniqueInfo& info);

/// A parameter of all truths.
inline constexpr ParameterInfo kMaxEvents{.name = "events",
                                          .unit = "",
                                          .default_value = 16,
                                          .minimum = 1,
                                          .maximum = 4095,
                                          .whole = true,
                                          .doc = "interface events that exact paths may have"};

/// Has the host trace one exact path per pixel of the frame, up to kMaxEvents events, when the frame gets there. The tracer
/// lives until then.
Refraction trace_exact_paths(Recorder& recorder, const Frame& frame, const TracedView& view,
                             const ParameterValues& parameters);

/// Likewise one sample of the image that `truth` traces itself, of the whole picture. RGBA32F. `environment` lives until
/// then, too.
const GpuImage& trace_sample(Recorder& recorder, const Frame& frame, const Truth& truth, const TracedView& view,
                             const Environment& environment, std::uint32_t sample, const ParameterValues& parameters);

}  // namespace pellucid
