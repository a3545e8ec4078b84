#include "reference/light_flux.h"

#include "reference/photon_emission.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pellucid::reference {
namespace {

constexpr std::uint32_t kMostPoints = 1u << 17;  ///< points per object
constexpr std::uint32_t kLeastPoints = 1u << 10;
constexpr std::uint32_t kAllPoints = 1u << 20;

/// Points spread over an object's triangles by their area.
class SurfacePoints {
public:
    SurfacePoints(const Geometry& geometry, std::uint32_t object) : geometry_(geometry), object_(object) {
        const std::size_t triangles = geometry.mesh(object).triangles.size();
        for (std::uint32_t t = 0; t < triangles; ++t) {
            area_ += 0.5 * glm::length(geometry.at(object, t, 0.0, 0.0).normal);
            area_up_to_.push_back(area_);
        }
    }
    double area() const { return area_; }  ///< m2

    /// `place`: 0..1, position in the cumulative area of all triangles.
    Hit at(double place, const glm::dvec2& u) const {
        const auto found = std::upper_bound(area_up_to_.begin(), area_up_to_.end() - 1, place * area_);
        const auto triangle = std::uint32_t(found - area_up_to_.begin());
        const double root = std::sqrt(u.x);
        return geometry_.at(object_, triangle, root * (1.0 - u.y), root * u.y);
    }

private:
    const Geometry& geometry_;
    std::uint32_t object_;
    std::vector<double> area_up_to_;
    double area_ = 0.0;
};

/// Flux, W, from shadow rays to both sides of an opaque object.
glm::dvec3 direct_flux(const PathWorld& world, std::uint32_t object, std::uint32_t count, std::uint32_t seed) {
    const SurfacePoints points(world.geometry, object);
    if (!(points.area() > 0.0)) return glm::dvec3(0.0);
    std::vector<glm::dvec3> found(count);
    constexpr std::uint32_t kBlock = 256;
    tbb::parallel_for(0u, (count + kBlock - 1) / kBlock, [&](std::uint32_t block) {
        PathWalk walk(world);
        for (std::uint32_t i = block * kBlock; i < std::min((block + 1) * kBlock, count); ++i) {
            Random random(seed, (std::uint64_t(1) << 62) + object, i);
            const double place = (i + random.next()) / count;
            found[i] = walk.irradiance(points.at(place, random.next2()), random);
        }
    });
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& irradiance : found) sum += irradiance;
    return sum * (points.area() / count);
}

}  // namespace

std::vector<LightFlux> light_flux(const Geometry& geometry, const CurvedVolumes& volumes, const Scene& scene,
                                  std::uint32_t photons, std::uint32_t seed, std::uint32_t threads) {
    std::vector<LightFlux> flux(geometry.object_count());
    if (scene.lights.empty() || flux.empty()) return flux;
    Environment dark;
    dark.kind = Environment::Kind::kUniform;
    dark.uniform_radiance = glm::vec3(0.0f);
    const EnvironmentSampler sampler(dark);
    const PathWorld world{.geometry = geometry,
                          .volumes = volumes,
                          .scene = scene,
                          .environment = dark,
                          .sampler = sampler,
                          .has_panes = has_panes(geometry)};
    const auto points = std::clamp(kAllPoints / geometry.object_count(), kLeastPoints, kMostPoints);
    tbb::task_arena arena(threads > 0 ? int(threads) : tbb::task_arena::automatic);
    arena.execute([&] {
        for (std::uint32_t object = 0; object < flux.size(); ++object) {
            if (geometry.kind(object) == SurfaceKind::kOpaque)
                flux[object].direct = direct_flux(world, object, points, seed);
        }
        const PhotonEmitter emitter(geometry, volumes, scene);
        if (photons == 0 || emitter.dark()) return;
        for (const Photon& photon : shoot_photons(world, emitter, photons, seed, 0))
            flux[photon.crossing.object].photons += glm::dvec3(photon.flux) / double(photon.share);
    });
    return flux;
}

}  // namespace pellucid::reference
