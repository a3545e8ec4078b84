#pragma once

#include "reference/path_walk.h"
#include "reference/photon_map.h"
#include "reference/random.h"

#include <pellucid/scene.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::reference {

/// Emits photons from directional, point and spot lights towards the sphere around all smooth objects. Only light that
/// meets these is out of reach of next-event estimation. A sized light emits photons from its whole disc or ball.
class PhotonEmitter {
public:
    /// The arguments must outlive the emitter.
    PhotonEmitter(const Geometry& geometry, const CurvedVolumes& volumes, const Scene& scene);

    /// True if no light reaches a smooth object.
    bool dark() const { return aims_.empty(); }
    /// Names of lights without a size. Without photons, their light on smooth objects is lost.
    std::vector<std::string> without_size() const;
    /// Look-up radius of the first round, m. A look-up finds 16 of `count` photons if nothing bends light across the
    /// sphere.
    double first_radius(std::uint32_t count) const;
    double emitted() const { return aims_.empty() ? 0.0 : aims_.back().power_up_to; }  ///< W, brightest channel

    /// Emits one of `count` photons. Its light is chosen in proportion to its flux towards the sphere.
    void shoot(PathWalk& walk, std::uint32_t count, Random& random, std::vector<Photon>& stored) const;

private:
    struct Sphere {
        glm::dvec3 center{0.0};
        double radius = 0.0;  ///< m; 0: no object is smooth
    };
    /// A light and its photons' starts: directions in a cone, through a disc perpendicular to each direction.
    struct Aim {
        const Light* light;
        std::optional<MediumStack> inside;  ///< solids around the light; empty: they differ between photons
        glm::dvec3 center;    ///< centre of the discs: of the sphere for a directional light, else of the light
        double disc = 0.0;    ///< radius of the discs, m: of the sphere for a directional light, else of the light
        double before = 0.0;  ///< directional light: m from `center` back to the photons' start
        glm::dmat3 world_from_cone{1.0};  ///< the cone's axis is z
        double one_less_cosine = 2.0;     ///< 1 - cos of the cone's half angle
        double power_up_to = 0.0;  ///< cumulative flux in the brightest channel, W, up to and including this light
    };
    static Sphere smooth_bounds(const Geometry& geometry, const CurvedVolumes& volumes, const Scene& scene);
    Aim aim_of_sun(const Scene& scene, const Light& light) const;
    Aim aim_of_lamp(const Light& light) const;
    double measure(const Aim& aim) const;
    PhotonStart start(const Aim& aim, Random& random) const;

    const Geometry& geometry_;
    Sphere target_;
    std::vector<Aim> aims_;
};

/// Photons of one round; independent of the number of threads.
std::vector<Photon> shoot_photons(const PathWorld& world, const PhotonEmitter& emitter, std::uint32_t count,
                                  std::uint32_t seed, std::uint32_t round);

}  // namespace pellucid::reference
