#pragma once

#include "reference/camera_rays.h"
#include "reference/curved_volumes.h"
#include "reference/geometry.h"

#include <pellucid/path_surfaces.h>

#include <cstdint>
#include <vector>

namespace pellucid::reference {

/// One exact path, traced from surface to surface. Construct one per lane and reuse it for many pixels.
class ExactPath {
public:
    /// `channel`: the colour whose indices of refraction apply, kRed to kBlue.
    ExactPath(const Geometry& geometry, std::uint32_t max_events, int channel);

    /// Starts a new path. `inside`: the solids around ray.origin.
    void start(const CameraRay& ray, const MediumStack& inside);
    /// The next ray to intersect; valid until advance().
    const Query& query() const { return ray_; }
    /// Continues the path at `hit`. Returns false at the end of the path.
    bool advance(const Hit& hit);
    /// Continues the path in scenes with volumes, where it also finds the next hit. Returns false at the end of the
    /// path.
    bool fly(const CurvedVolumes& volumes);
    const RefractedPath& result() const { return result_; }
    /// The path with the surfaces that it met.
    SurfacePath surfaces() const;

private:
    void travel(const Hit& hit);
    bool cross(const Hit& hit);
    void bend(const Hit& hit);
    double ior(const MediumStack& at, const glm::dvec3& position) const;
    bool finish(Status status);

    const Geometry& geometry_;
    std::uint32_t max_events_;
    int channel_;
    Query ray_;
    MediumStack inside_;              ///< the solids around the origin
    MediumStack beyond_;              ///< the solids behind the boundaries at the current hit
    std::vector<Crossing> standing_;  ///< triangles that the origin lies on
    glm::dvec3 transmittance_{1.0};
    double length_ = 0.0, length_inside_ = 0.0;
    double open_ior_ = 1.0;  ///< index outside all solids, at the origin
    bool crossed_volume_ = false;
    bool in_held_volume_ = false;  ///< the last segment lies in the volume of a solid
    const CurvedVolumes* volumes_ = nullptr;
    RefractedPath result_;
    SurfacePath met_;  ///< all but the path
};

}  // namespace pellucid::reference
