#include "reference/photon_kernel.h"

#include "reference/local_frame.h"
#include "reference/random.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace pellucid::reference {
namespace {

using std::numbers::pi;

constexpr int kRimPoints = 8;    ///< a receiver found at all of these points covers the disc
constexpr int kDiscPoints = 64;  ///< otherwise the disc is tested at this many points
constexpr double kBeyond = 1.3;  ///< length of test rays to a curved receiver, relative to their distance from the disc
constexpr double kLeastPixels = 0.25;

/// The disc around a photon, seen from above, on the photon's incident side.
class Disc {
public:
    Disc(const Geometry& geometry, const Photon& photon)
        : geometry_(geometry), photon_(photon), world_from_disc_(world_from_local(glm::dvec3(photon.normal))) {
        const double side = glm::dot(photon.direction, photon.normal) < 0.0f ? 1.0 : -1.0;
        const glm::dvec3 up = side * world_from_disc_[2];
        Crossing standing = photon.crossing;
        standing.sense = geometry.sense(standing.object, standing.triangle, up);
        Query query;
        query.origin = photon.position;
        query.direction = up;
        query.t_max = double(photon.radius);
        query.standing = {&standing, 1};
        query.kinds = only(geometry.kind(standing.object));
        const Hit ceiling = geometry.intersect(query);
        above_ = photon.position + (ceiling.found ? 0.5 * ceiling.t : query.t_max) * up;
    }

    /// True if the receiver covers a point of the disc. `from_center` in radii, `angle` in radians.
    bool covered(double from_center, double angle) const {
        const glm::dvec3 in_disc(from_center * std::cos(angle), from_center * std::sin(angle), 0.0);
        const glm::dvec3 way = photon_.position + double(photon_.radius) * (world_from_disc_ * in_disc) - above_;
        const double length = glm::length(way);
        Query query;
        query.origin = above_;
        query.direction = way / length;
        query.t_max = kBeyond * length;
        query.kinds = only(geometry_.kind(photon_.crossing.object));
        const Hit hit = geometry_.intersect(query);
        return hit.found && of_one_surface(geometry_.geometric_normal(hit), glm::dvec3(photon_.normal));
    }

private:
    const Geometry& geometry_;
    const Photon& photon_;
    glm::dmat3 world_from_disc_;
    glm::dvec3 above_{0.0};
};

/// Share of the disc around a photon covered by its receiver, > 0.
double covered_share(const Geometry& geometry, const Photon& photon, Random& random) {
    const Disc disc(geometry, photon);
    const double turn = 2.0 * pi * random.next();
    int found = 0;
    for (int i = 0; i < kRimPoints; ++i) found += disc.covered(1.0, turn + 2.0 * pi * i / kRimPoints) ? 1 : 0;
    if (found == kRimPoints) return 1.0;
    // Uniform points on the disc (Vogel, "A better way to construct the sunflower head", 1979).
    const double golden = pi * (3.0 - std::sqrt(5.0));
    found = 0;
    for (int i = 0; i < kDiscPoints; ++i)
        found += disc.covered(std::sqrt((i + 0.5) / kDiscPoints), turn + golden * i) ? 1 : 0;
    return std::max(found, 1) / double(kDiscPoints);
}

}  // namespace

void spread_over_receivers(const Geometry& geometry, const CameraRays& rays, double radius, std::uint32_t seed,
                           std::vector<Photon>& photons) {
    tbb::parallel_for(std::size_t(0), photons.size(), [&](std::size_t i) {
        Photon& photon = photons[i];
        photon.radius = float(std::max(radius, kLeastPixels * rays.pixel_size(photon.position)));
        Random random(seed, i, ~std::uint64_t(0));
        const double disc = pi * double(photon.radius) * double(photon.radius);
        photon.area = float(disc * covered_share(geometry, photon, random));
    });
}

}  // namespace pellucid::reference
