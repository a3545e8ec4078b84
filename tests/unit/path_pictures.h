#pragma once

// Pictures of the path tracer, and what is asked of their means.
#include "traced_scenes.h"

#include <gtest/gtest.h>

#include <glm/glm.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace pellucid::test {

struct Seen {
    double radiance, error;
};
inline Seen mean_of(const PathTracedImage& image) {
    Seen seen{0.0, 0.0};
    const double count = double(image.radiance.pixels.size());
    for (const float value : image.radiance.pixels) seen.radiance += double(value) / count;
    for (const float error : image.standard_error.pixels) seen.error += double(error) * double(error) * 3.0;
    return {seen.radiance, std::sqrt(seen.error) / count};
}

inline PathTracedImage trace_picture(const Scene& scene, const Camera& camera, float sky, std::uint32_t size,
                                     std::uint32_t samples, std::uint32_t photons = 0) {
    return Tracer(scene).path_trace(camera, uniform(sky),
                                    {.width = size, .height = size, .samples = samples, .photons = photons});
}

/// What one ray through `target` sees without a sky.
inline Seen look(const Scene& scene, glm::vec3 target, glm::vec3 direction, std::uint32_t samples,
                 float distance = 10.0f) {
    return mean_of(trace_picture(scene, parallel_camera(target, direction, 1e-4f, distance), 0.0f, 1, samples));
}

inline void expect_seen(const Seen& seen, double expected) {
    EXPECT_NEAR(seen.radiance, expected, 4.0 * seen.error + 1e-4 * expected);
}

}  // namespace pellucid::test
