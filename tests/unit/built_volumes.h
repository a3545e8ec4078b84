#pragma once

// Volumes of which the rays are known.
#include <pellucid/volume.h>

#include <glm/glm.hpp>

namespace pellucid::test {

/// A cube of 2 half-edges around the origin in which nothing bends light.
inline Volume even_cube(float half, unsigned resolution = 8) {
    Volume volume;
    volume.name = "even";
    volume.size = glm::uvec3(resolution);
    volume.low = glm::vec3(-half);
    volume.voxel = 2.0f * half / float(resolution);
    return volume;
}

/// An index that falls from the middle of a unit ball to its surface, middle - fall r^2, and on beyond it.
inline Volume graded_ball(float middle, float fall, unsigned resolution = 64) {
    Volume volume = even_cube(1.1f, resolution);
    for (unsigned z = 0; z < resolution; ++z) {
        for (unsigned y = 0; y < resolution; ++y) {
            for (unsigned x = 0; x < resolution; ++x) {
                const glm::vec3 at = volume.low + volume.voxel * (glm::vec3(x, y, z) + 0.5f);
                volume.n.push_back(middle - fall * glm::dot(at, at));
            }
        }
    }
    return volume;
}

}  // namespace pellucid::test
