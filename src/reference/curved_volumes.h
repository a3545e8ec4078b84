#pragma once

#include "reference/geometry.h"
#include "reference/random.h"

#include <pellucid/scene.h>
#include <pellucid/volume.h>

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace pellucid::reference {

class SizedLights;

/// The volumes of a scene, and curved rays in them, in double precision.
///
/// - The index is interpolated by uniform cubic B-splines over the voxels, whose exact gradient is used. Absorption,
///   scattering and emission are interpolated linearly.
/// - Rays obey d/ds (n dx/ds) = grad n (Ihrke et al. 2007, equations 9 and 10). They are integrated by the method of
///   Dormand & Prince with a relative tolerance of 1e-7 a step (Boost.Odeint).
/// - Light crosses the faces of boxes unbent. Where boxes overlap, the smaller box applies.
/// - Out-scattered light is lost; in-scattered light is ignored.
/// - Surfaces of a volume (Volume::boundary) reflect by Fresnel's equations between the indices on either side.
///   Reflection is sampled at random, or the transmitted path is attenuated by it.
/// - A volume assigned to objects of a solid bends rays inside that solid only. The solid's surfaces are sharp.
class CurvedVolumes {
public:
    /// The scene's volumes must outlive this.
    CurvedVolumes(const Scene& scene, const Geometry& geometry);

    bool empty() const { return open_.empty() && held_.empty(); }
    /// True if rays can bend in `solid`, an index into Geometry::solids(), or kAir.
    bool bends_in(std::int32_t solid) const { return !volumes_of(solid).empty(); }
    bool disperses() const;  ///< some volume has a separate index per colour

    /// Index of refraction in a solid with a volume; empty if the solid has none at `position`.
    std::optional<double> index_at(std::int32_t solid, const glm::dvec3& position, int channel) const;

    /// A path in one medium, from a ray's start to the next surface.
    struct Flight {
        Hit hit;                     ///< hit on the last, straight segment: from Query::origin along Query::direction
        double length = 0.0;         ///< m, before the last segment
        double length_inside = 0.0;  ///< m in volumes
        glm::dvec3 transmittance{1.0};  ///< transmittance of the whole path
        glm::dvec3 emission{0.0};       ///< radiance added by emission, as it arrives at the start
        double ior = 1.0;               ///< index at the end of the path
        double basic = 1.0;             ///< n^2 at the face of the last volume over n^2 at the path's end
        const Light* ball = nullptr;    ///< the light whose ball was hit, if any
        bool met = false;               ///< part of the path lies in a volume
        bool stuck = false;             ///< a volume has trapped the ray
        bool ends_inside = false;       ///< the last segment lies in a volume
        glm::dvec3 left_at{0.0};        ///< world; exit point from the last volume
        double left_after = 0.0;        ///< m from the start to `left_at`
    };
    /// Follows a path to the next surface; `query` then contains the last segment. `channel`: kRed to kBlue. With
    /// `random`, surfaces of volumes reflect or transmit at random; without it, every path is transmitted. With
    /// `lights`, their balls are intersected too.
    Flight fly(std::int32_t solid, const Geometry& geometry, Query& query, int channel, Random* random = nullptr,
               const SizedLights* lights = nullptr) const;

    /// True if a straight segment outside all solids enters a box.
    bool meets(const glm::dvec3& origin, const glm::dvec3& direction, double distance) const;

private:
    struct Placed;
    struct Span {
        double near = 0.0, far = -1.0;  ///< m along a ray, from 0; empty if far <= near
    };
    using List = std::vector<std::shared_ptr<const Placed>>;  ///< sorted by size, smallest box first
    const List& volumes_of(std::int32_t solid) const;
    static Span crossing(const Placed& placed, const glm::dvec3& origin, const glm::dvec3& direction);
    static std::size_t next_volume(const List& volumes, const glm::dvec3& origin, const glm::dvec3& direction,
                                   double& distance);
    static bool bend(const List& volumes, std::size_t own, const Geometry& geometry, Query& query, int channel,
                     Random* random, const SizedLights* lights, Flight& flight);

    List open_;
    std::map<std::int32_t, List> held_;  ///< key: solid
};

}  // namespace pellucid::reference
