#pragma once

#include <pellucid/pellucid.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid::cli {

/// The processor that traces are timed on.
std::string cpu_name();

/// Tracer::trace_fast of one view.
struct TimedTrace {
    const Tracer& tracer;
    const Camera& camera;
    ExactSettings settings;
};

/// Times of frames, and of traces of the same view between them, so that what else the machine does hits both.
struct AlternatingTimes {
    std::vector<double> frames_ms;                                       ///< sums over the passes
    std::vector<std::pair<std::string, std::vector<double>>> passes_ms;  ///< in their order
    std::vector<double> traces_ms;
};

/// Draws `frames` frames and traces as often, in blocks. The frame at the head of every block, which is drawn
/// through pixel centres, is not counted; those that are counted all have the same passes.
/// Throws DeviceError if the device has no timestamps.
AlternatingTimes time_alternately(Renderer& renderer, RenderSettings settings, int frames, const TimedTrace& trace,
                                  const Progress& progress);

/// The packet size (see ExactSettings) with which the view is traced fastest.
std::uint32_t fastest_packet(TimedTrace trace);

/// A tracer as fast as they get, and the median time of building its hierarchy, ms, after one that starts threads.
struct TimedTracer {
    Tracer tracer;
    double build_ms;
};
TimedTracer build_timed(const Scene& scene, std::uint32_t threads);

/// What ray tracing pays for meshes that deform from frame to frame, medians in ms.
struct DeformingTimes {
    double refit_ms = 0.0, rebuild_low_ms = 0.0, rebuild_medium_ms = 0.0;
    double best_ms = 0.0;  ///< the least of these with the trace of the hierarchy that it leaves
};
DeformingTimes time_deforming(const Scene& scene, const Camera& camera, const ExactSettings& settings,
                              std::uint32_t threads);

}  // namespace pellucid::cli
