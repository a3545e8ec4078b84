#pragma once

#include "reference/bsdf.h"
#include "reference/camera_rays.h"
#include "reference/curved_volumes.h"
#include "reference/emitter_sampler.h"
#include "reference/environment_sampler.h"
#include "reference/geometry.h"
#include "reference/photon_map.h"
#include "reference/punctual_lights.h"
#include "reference/random.h"
#include "reference/texture_lookup.h"

#include <pellucid/environment.h>
#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pellucid::reference {

/// What all paths of a picture share.
struct PathWorld {
    const Geometry& geometry;
    const CurvedVolumes& volumes;
    const Scene& scene;
    const Environment& environment;
    const EnvironmentSampler& sampler;
    std::uint32_t max_vertices = 256;
    bool has_panes = false;                    ///< the scene has thin-walled glass
    const PhotonMap* photons = nullptr;        ///< of light that next-event estimation cannot follow; null: none
    const EmitterSampler* emitters = nullptr;  ///< null: paths meet emissive surfaces by chance alone
};

bool has_panes(const Geometry& geometry);

/// A photon as its light sends it.
struct PhotonStart {
    CameraRay ray;
    const Light* light = nullptr;
    glm::dvec3 flux{0.0};  ///< W, RGB
};

/// What light a picture is made of, in Heckbert's notation (Heckbert, "Adaptive radiosity textures for bidirectional ray
/// tracing", 1990); D is every surface that is not smooth, and light straight through panes met nothing.
enum class LightPart : std::uint8_t {
    kEmitted,   ///< E S* L
    kDirect,    ///< E S* D L
    kCaustic,   ///< E S* D S+ L
    kIndirect,  ///< E S* D (S* D)+ S* L
};
using LightParts = std::array<glm::dvec3, 4>;  ///< radiance, by LightPart

/// One light path at a time, from the eye backwards (Kajiya 1986), with light sources and the
/// environment asked for at every surface that scatters (Veach, "Robust Monte Carlo methods for light
/// transport simulation", 1997, sections 9.2 and 10.2).
///
/// The environment is reached in two ways, by a direction that it chose or one that the surface chose,
/// combined by the power heuristic. Light that was chosen by its source comes through holes and smooth
/// panes, but not through refracting glass, so what a path finds behind such glass, or in any perfect
/// mirror, counts in full.
///
/// Around all solids a path bends in volumes (curved_volumes.h). As behind refracting glass, light behind a volume is found
/// by chance or by photons: without photons, lights that are points do not shine through volumes.
///
/// Lights of the scene that have a size are met by chance, too, combined with those that were chosen. A path may meet
/// one after a mirror or a refraction that follows on a surface that is not smooth: it counts if there are no photons,
/// which else have that light. The same goes for emissive surfaces, except that they send no photons.
///
/// Colours part at the first boundary of a dispersive medium, or volume: the path goes on with one channel, at whose
/// indices it is refracted from there on.
///
/// Photons go the same way from a light. Let x be the first surface from the light that is not smooth. Where no smooth
/// event lies between, or light comes straight through panes, next-event estimation has it; else a photon is stored at x,
/// and paths from the eye read it there.
class PathWalk {
public:
    explicit PathWalk(const PathWorld& world)
        : world_(world), lights_(world.scene.lights), inside_(world.geometry.solids()),
          beyond_(world.geometry.solids()) {}

    struct Result {
        glm::dvec3 radiance{0.0};
        LightParts parts{};  ///< they add up to `radiance`
        bool cut = false;    ///< reached max_vertices; what would have come after is missing
    };
    /// `inside`: the solids around the ray's origin.
    Result walk(const CameraRay& ray, const MediumStack& inside, Random& random);
    /// Flux density, W/m2, that shadow rays find at a point of an opaque surface, over both sides.
    glm::dvec3 irradiance(const Hit& on, Random& random);
    /// Appends to `stored` what next-event estimation cannot follow of a photon. `inside`: the solids around its light.
    void follow(const PhotonStart& photon, const MediumStack& inside, Random& random, std::vector<Photon>& stored);

private:
    /// A surface that the path has come to.
    struct Vertex {
        Hit hit;
        const Material& material;
        SurfaceAttributes attributes;
        glm::dvec4 base;    ///< base colour, 0..1
        glm::dvec3 normal;  ///< unit, on the side that the path comes from, tilted by its texture
        glm::dvec3 smooth;  ///< likewise, without its texture
    };
    /// The surface's own frame, and the way back in it.
    struct Facing {
        glm::dmat3 world_from_local;
        glm::dvec3 wo;
    };
    /// What is followed from a light.
    struct FromLight {
        std::vector<Photon>* stored = nullptr;  ///< null: the path comes from the eye
        const Light* light = nullptr;
        double flux = 0.0;  ///< W where throughput_ is 1
    };
    /// Paths are ended at random from this surface on (Russian roulette).
    static constexpr std::uint32_t kRouletteFrom = 4;

    void start(const CameraRay& ray, const MediumStack& inside);
    Hit next_surface(Random& random, bool& caught);
    void bend();
    void cover(double distance);
    void travel(const Hit& hit);
    void turn_to(const glm::dvec3& direction);
    Vertex vertex_at(const Hit& hit, const glm::dvec3& direction) const;
    bool crosses(const Hit& hit, const glm::dvec3& direction) const;

    bool meet(const Hit& hit, Random& random);
    bool meet_opaque(const Vertex& vertex, Random& random);
    bool meet_solid(const Hit& hit, Random& random);
    bool meet_pane(const Vertex& vertex, Random& random);
    void emit(const Vertex& vertex);
    double emitted_share() const { return emitted_share(inside_, open_share_); }
    double emitted_share(const MediumStack& at, double open_share) const;
    bool refracts_towards(const Hit& from, const glm::dvec3& direction) const;
    double ior(const MediumStack& at, int channel) const;
    bool transmits(const Vertex& vertex, Random& random) const;
    Bsdf opaque_bsdf(const Vertex& vertex) const;
    FinishedBsdf finished_bsdf(const Vertex& vertex, const glm::dvec3& base) const;
    double roughness_at(const Vertex& vertex) const;
    bool scatter(const Vertex& vertex, const Bsdf& bsdf, Random& random);
    void scatter_from(const glm::dvec3& position, double pdf);
    bool survives(Random& random);
    void choose_channel(Random& random);

    void receive(LightPart part, const glm::dvec3& light) {
        radiance_ += light;
        parts_[std::size_t(part)] += light;
    }
    LightPart part() const;
    LightPart part_through(LightPart of_first) const { return scatters_ == 0 ? of_first : LightPart::kIndirect; }
    double weight_of_chance(const Light& light) const;
    double weight_of_chance(const Hit& emitter) const;
    void see_sky();
    void see_ball(double distance);
    void add_environment(const Vertex& vertex, const Bsdf& bsdf, const Facing& facing, Random& random);
    void add_light(const Light& light, const Vertex& vertex, const Bsdf& bsdf, const Facing& facing, Random& random);
    void add_emission(const Vertex& vertex, const Bsdf& bsdf, const Facing& facing, Random& random);
    void add_photons(const Vertex& vertex, const Bsdf& bsdf, const Facing& facing, Random& random);
    BsdfValue value_towards(const Vertex& vertex, const Bsdf& bsdf, const Facing& facing, const glm::dvec3& direction,
                            Random& random) const;
    void deposit(const Vertex& vertex);
    bool cross_as_photon(const Vertex& vertex, const InterfaceBsdf& bsdf, Random& random);
    double adjoint_weight(const Vertex& vertex, const glm::dvec3& wi, const glm::dvec3& wo) const;
    glm::dvec3 visibility(const Hit& from, const glm::dvec3& direction, double distance, const Light* light);
    glm::dvec3 visible_emission(const Hit& from, const EmitterSampler::Sample& chosen);
    const MediumStack& medium_towards(const Hit& from, const glm::dvec3& direction) const {
        return refracts_towards(from, direction) ? beyond_ : inside_;
    }
    Query shadow_ray(const Hit& from, const glm::dvec3& direction, double distance);
    bool meets_volume(const MediumStack& inside, const Query& query) const;
    void step_through(const Hit& pane, Query& query);
    glm::dvec3 straight_through(const Vertex& pane, const glm::dvec3& direction) const;
    glm::dvec3 pane_transmittance(Query query);

    const PathWorld& world_;
    SizedLights lights_;
    Query ray_;
    const Light* ball_ = nullptr;     ///< the ray has met the ball of this light
    std::vector<Crossing> standing_;  ///< what ray_.origin lies on
    std::vector<Crossing> shadow_standing_;
    MediumStack inside_;  ///< the solids around the ray
    MediumStack beyond_;  ///< those on the other side of the surface at hand
    glm::dvec3 throughput_{1.0};
    glm::dvec3 radiance_{0.0};
    LightParts parts_{};
    std::optional<int> channel_;  ///< the only one that the path still carries; none: all
    /// Density, per steradian, with which the last surface that scattered chose the ray's direction; 0 if
    /// no source can choose this path. Of a photon: 0 from its first mirror or refraction on.
    double pdf_ = 0.0;
    glm::dvec3 scattered_at_{0.0};  ///< world, m: position of that surface
    std::uint32_t scatters_ = 0;    ///< surfaces on the path that were not smooth
    bool bent_ = false;             ///< there was a mirror, a refraction or a volume after the last of them
    FromLight photon_;
    double length_ = 0.0;          ///< m along straight pieces, from the start or the last surface that scattered
    bool in_held_volume_ = false;  ///< the last piece of the way was in the volume of a solid
    double open_ior_ = 1.0;        ///< of what is around all solids, at the ray's origin
    /// Of what is emitted there, the share that arrives where the path entered the volume.
    double open_share_ = 1.0;
};

}  // namespace pellucid::reference
