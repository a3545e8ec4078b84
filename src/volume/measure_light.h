#pragma once

#include "volume/light_settings.h"

#include <pellucid/device.h>
#include <pellucid/image.h>
#include <pellucid/scene.h>

#include <vector>

namespace pellucid {

/// The light on one planar object.
struct LightMap {
    glm::dvec3 corner{0.0}, side{0.0}, up{0.0};  ///< world, m; unit
    double texel = 0.0;                          ///< edge, m
    Image irradiance;                            ///< RGB, W/m2; rows along `up`, from the corner on
};

struct MeasuredLight {
    LightStatistics statistics;
    double device_ms = 0.0;  ///< median over the repetitions; by timestamps, 0 where there are none
    double wall_ms = 0.0;    ///< likewise, by the clock: recording, submitting and waiting
    double voxel = 0.0;      ///< edge of the smallest voxel, m
    std::vector<LightMap> receivers;
};

/// Traces the lights of a scene through its volumes on a device of its own: once to compile and to upload, then
/// `repetitions` times (>= 1) with the clock. Throws Error as WavefrontTracer::update().
MeasuredLight measure_light(const DeviceOptions& device, const Scene& scene, const LightSettings& settings,
                            int repetitions);

}  // namespace pellucid
