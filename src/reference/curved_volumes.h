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

/// The volumes of a scene, and rays that bend in them, in double precision.
///
/// - The index is interpolated by uniform cubic B-splines over the voxels: its gradient is that of the value itself. Absorption, scattering and emission are interpolated linearly.
/// - Rays obey d/ds (n dx/ds) = grad n (Ihrke et al. 2007, equations 9 and 10), by the method of Dormand & Prince with a
///   relative tolerance of 1e-7 a step (Boost.Odeint).
/// - Light crosses the faces of boxes straight on. Where boxes overlap the smaller counts.
/// - What is scattered out of the way is lost; what is scattered into it is left out.
/// - Surfaces of a volume (Volume::boundary) reflect what those between the indices on either side do (Fresnel): at random,
///   or from the transmitted path, that loses it.
/// - A volume that stands for objects of a solid is held by it: rays bend in it inside the solid, whose surfaces are sharp,
///   and nowhere else.
class CurvedVolumes {
public:
    /// The scene's volumes must outlive this.
    CurvedVolumes(const Scene& scene, const Geometry& geometry);

    bool empty() const { return open_.empty() && held_.empty(); }
    /// Whether rays can bend there; `solid`: Geometry::solids(), or kAir.
    bool bends_in(std::int32_t solid) const { return !volumes_of(solid).empty(); }
    bool disperses() const;  ///< some volume has an index per colour

    /// Index of a solid that holds a volume; nothing where there is none.
    std::optional<double> index_at(std::int32_t solid, const glm::dvec3& position, int channel) const;

    /// A way in one medium, from where a ray starts to the next surface.
    struct Flight {
        Hit hit;                        ///< on the last, straight piece: from Query::origin along Query::direction
        double length = 0.0;            ///< m, before that piece
        double length_inside = 0.0;     ///< m in volumes
        glm::dvec3 transmittance{1.0};  ///< of all of the way
        glm::dvec3 emission{0.0};       ///< radiance that was added, as it arrives at the start
        double ior = 1.0;               ///< where the way ends
        double basic = 1.0;             ///< n^2 at the face of the volume in which it ends, over n^2 where it ends
        const Light* ball = nullptr;    ///< `hit` is on the ball of this light
        bool met = false;               ///< some of it was in a volume
        bool stuck = false;             ///< a volume has caught the ray
        bool ends_inside = false;       ///< the last piece is in a volume
        glm::dvec3 left_at{0.0};        ///< world, where the last volume was left
        double left_after = 0.0;        ///< m from the start to there
    };
    /// `channel`: kRed to kBlue. Leaves in `query` the last piece.
    /// With `random` surfaces of volumes reflect or transmit by chance; without, every path is transmitted.
    /// With `lights` their balls are met, too.
    Flight fly(std::int32_t solid, const Geometry& geometry, Query& query, int channel, Random* random = nullptr,
               const SizedLights* lights = nullptr) const;

    /// Whether a straight way in the open meets a box.
    bool meets(const glm::dvec3& origin, const glm::dvec3& direction, double distance) const;

private:
    struct Placed;
    struct Span {
        double near = 0.0, far = -1.0;  ///< m along a ray, from 0; none if far <= near
    };
    using List = std::vector<std::shared_ptr<const Placed>>;  ///< the smallest box first
    const List& volumes_of(std::int32_t solid) const;
    static Span crossing(const Placed& placed, const glm::dvec3& origin, const glm::dvec3& direction);
    static std::size_t next_volume(const List& volumes, const glm::dvec3& origin, const glm::dvec3& direction,
                                   double& distance);
    static bool bend(const List& volumes, std::size_t own, const Geometry& geometry, Query& query, int channel,
                     Random* random, const SizedLights* lights, Flight& flight);

    List open_;
    std::map<std::int32_t, List> held_;  ///< by solid
};

}  // namespace pellucid::reference
