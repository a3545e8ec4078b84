#pragma once

#include <pellucid/pellucid.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid::cli {

/// Name of the processor that runs the traces.
std::string cpu_name();

/// Arguments of Tracer::trace_fast for one view.
struct TimedTrace {
    const Tracer& tracer;
    const Camera& camera;
    ExactSettings settings;
};

/// Times of frames, alternating with traces of the same view, so that other load affects both.
struct AlternatingTimes {
    std::vector<double> frames_ms;                                       ///< sums over the passes
    std::vector<std::pair<std::string, std::vector<double>>> passes_ms;  ///< in pass order
    std::vector<double> traces_ms;
};

/// Draws `frames` frames and equally many traces, in blocks. The first frame of every block, through pixel centres, is
/// not counted. All counted frames have the same passes. Throws DeviceError if the device has no timestamps.
AlternatingTimes time_alternately(Renderer& renderer, RenderSettings settings, int frames, const TimedTrace& trace,
                                  const Progress& progress);

/// The packet size (see ExactSettings) that traces the view fastest.
std::uint32_t fastest_packet(TimedTrace trace);

/// A tracer with the fastest options, and the median build time of its hierarchy, ms, after a first build that starts
/// threads.
struct TimedTracer {
    Tracer tracer;
    double build_ms;
};
TimedTracer build_timed(const Scene& scene, std::uint32_t threads);

/// Cost of ray tracing for deforming meshes, medians in ms.
struct DeformingTimes {
    double refit_ms = 0.0, rebuild_low_ms = 0.0, rebuild_medium_ms = 0.0;
    double best_ms = 0.0;  ///< least sum of an update and the trace that follows it
};
DeformingTimes time_deforming(const Scene& scene, const Camera& camera, const ExactSettings& settings,
                              std::uint32_t threads);

}  // namespace pellucid::cli
