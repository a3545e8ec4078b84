#pragma once

// Volumes of which the rays are known.
#include "optics/index_fields.h"

#include <pellucid/scene.h>
#include <pellucid/volume.h>

#include <glm/glm.hpp>

#include <cmath>
#include <memory>
#include <utility>

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

/// A slab of index n, half a metre thick and square to z, in a cube of 1 m.
inline Volume slab(float n, double smoothing, unsigned resolution) {
    Volume volume = even_cube(0.5f, resolution);
    const double sigma = smoothing * double(volume.voxel);
    for (unsigned z = 0; z < resolution; ++z) {
        const double off = std::abs(double(volume.low.z) + (z + 0.5) * double(volume.voxel)) - 0.25;
        const auto inside = float(smoothed_inside(off, sigma));
        volume.n.insert(volume.n.end(), resolution * resolution, 1.0f + (n - 1.0f) * inside);
        volume.boundary.insert(volume.boundary.end(), resolution * resolution,
                               float(std::exp(-0.5 * off * off / (sigma * sigma))));
    }
    return volume;
}

inline void add_volume(Scene& scene, Volume volume, const glm::mat4& world_from_volume = glm::mat4(1.0f)) {
    VolumeObject object;
    object.name = "volume";
    object.volume = int(scene.volumes.size());
    object.world_from_volume = world_from_volume;
    scene.volumes.push_back(std::make_shared<const Volume>(std::move(volume)));
    scene.volume_objects.push_back(object);
}

/// A cube of 2 m around the origin of what is the same everywhere.
inline Volume even(glm::vec3 sigma_a, glm::vec3 emission, float n = 1.0f) {
    Volume volume = even_cube(1.0f);
    volume.n.assign(volume.voxel_count(), n);
    volume.sigma_a.assign(volume.voxel_count(), sigma_a);
    volume.emission.assign(volume.voxel_count(), emission);
    return volume;
}

}  // namespace pellucid::test
