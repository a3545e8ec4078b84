#pragma once

#include "reference/camera_rays.h"
#include "reference/geometry.h"

#include <glm/glm.hpp>

#include <limits>

namespace pellucid::reference {

/// The solids around the start of each view ray.
class StartMedia {
public:
    StartMedia(const Geometry& geometry, const CameraRays& rays, glm::dvec2 size_px)
        : geometry_(geometry), fixed_(geometry.solids()) {
        if (rays.one_origin()) {
            fixed_ = geometry.solids_around(rays.at(0.5 * size_px).origin);
            return;
        }
        glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
        for (const glm::dvec2 corner :
             {glm::dvec2(0.0), glm::dvec2(size_px.x, 0.0), glm::dvec2(0.0, size_px.y), size_px}) {
            low = glm::min(low, rays.at(corner).origin);
            high = glm::max(high, rays.at(corner).origin);
        }
        per_ray_ = !geometry.in_air(low, high);
    }
    MediumStack around(const CameraRay& ray) const { return per_ray_ ? geometry_.solids_around(ray.origin) : fixed_; }

    /// True if around() is the same for every ray.
    bool fixed() const { return !per_ray_; }

private:
    const Geometry& geometry_;
    MediumStack fixed_;
    bool per_ray_ = false;
};

}  // namespace pellucid::reference
