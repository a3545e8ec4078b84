#pragma once

#include <pellucid/pellucid.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace pellucid::cli {

/// Times of frames, and of exact traces of the same view between them, so that what else the machine does hits both.
struct AlternatingTimes {
    std::vector<double> frames_ms;                                       ///< sums over the passes
    std::vector<std::pair<std::string, std::vector<double>>> passes_ms;  ///< in their order
    std::vector<double> traces_ms;
};

/// Draws `frames` frames and traces as often, in blocks; one frame at the head of every block is not counted.
/// Throws DeviceError if the device has no timestamps.
AlternatingTimes time_alternately(Renderer& renderer, RenderSettings settings, int frames, const Camera& camera,
                                  const ExactSettings& exact, const Progress& progress);

/// The packet size (see ExactSettings) with which the view is traced fastest.
std::uint32_t fastest_packet(const Tracer& tracer, const Camera& camera, ExactSettings exact);

/// What ray tracing pays for a mesh that deforms from frame to frame, medians in ms.
struct DeformingTimes {
    double refit_ms = 0.0, rebuild_low_ms = 0.0, rebuild_medium_ms = 0.0;
    double best_ms = 0.0;  ///< the least of these with the trace of the hierarchy that it leaves
};
DeformingTimes time_deforming(const Scene& scene, const Camera& camera, const ExactSettings& exact,
                              std::uint32_t threads);

}  // namespace pellucid::cli
