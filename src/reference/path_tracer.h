#pragma once

#include "reference/curved_volumes.h"
#include "reference/geometry.h"

#include <pellucid/environment.h>
#include <pellucid/progress.h>
#include <pellucid/reference.h>
#include <pellucid/scene.h>

#include <cstdint>

namespace pellucid::reference {

/// Implementation of Tracer::path_trace. `geometry` must have been built from `scene`; `threads` 0: all cores. Throws
/// Error for an invalid camera, environment or settings.
PathTracedImage trace_paths(const Geometry& geometry, const CurvedVolumes& volumes, const Scene& scene,
                            const Camera& camera, const Environment& environment, const PathTraceSettings& settings,
                            std::uint32_t threads, const Progress& progress);

}  // namespace pellucid::reference
