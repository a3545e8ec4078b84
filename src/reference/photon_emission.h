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

/// Photons of suns, lamps and spots, aimed at the sphere around everything smooth: only there is light that next-event
/// estimation cannot follow. A light with a size sends photons from all of its disc or ball.
class PhotonEmitter {
public:
    /// The arguments must outlive the emitter.
    PhotonEmitter(const Geometry& geometry, const CurvedVolumes& volumes, const Scene& scene);

    /// True if no light shines on anything smooth.
    bool dark() const { return aims_.empty(); }
    /// Names of lights without a size: without photons what they send onto smooth things is lost.
    std::vector<std::string> without_size() const;
    /// Radius of the first round's look-ups, m: where nothing bends light that runs across the sphere, a look-up finds
    /// 16 of `count` photons.
    double first_radius(std::uint32_t count) const;
    double emitted() const { return aims_.empty() ? 0.0 : aims_.back().power_up_to; }  ///< W, brightest channel

    /// One of `count` photons: its light is chosen in proportion to what that sends towards the sphere.
    void shoot(PathWalk& walk, std::uint32_t count, Random& random, std::vector<Photon>& stored) const;

private:
    struct Sphere {
        glm::dvec3 center{0.0};
        double radius = 0.0;  ///< m; 0: nothing is smooth
    };
    /// A light and where it sends its photons: in directions of a cone, through a disc across each of them.
    struct Aim {
        const Light* light;
        std::optional<MediumStack> inside;  ///< solids around the light; none: they differ from photon to photon
        glm::dvec3 center;                  ///< of the discs: of the sphere for a directional light, else of the light
        double disc = 0.0;                  ///< radius of the discs, m: of the sphere, or of the light
        double before = 0.0;                ///< m from `center` back to where photons of a directional light start
        glm::dmat3 world_from_cone{1.0};    ///< z is the cone's axis
        double one_less_cosine = 2.0;       ///< of the cone's half angle
        double power_up_to = 0.0;           ///< W in the brightest channel, of this light and those before it
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

/// Photons of one round, the same on any number of threads.
std::vector<Photon> shoot_photons(const PathWorld& world, const PhotonEmitter& emitter, std::uint32_t count,
                                  std::uint32_t seed, std::uint32_t round);

}  // namespace pellucid::reference
