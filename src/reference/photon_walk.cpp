// The part of PathWalk that follows light from its source (Jensen 1996) and looks up stored photons.
#include "reference/path_walk.h"
#include "reference/punctual_lights.h"

#include <algorithm>
#include <cmath>

namespace pellucid::reference {

void PathWalk::follow(const PhotonStart& photon, const MediumStack& inside, Random& random,
                      std::vector<Photon>& stored) {
    const double flux = std::max({photon.flux.r, photon.flux.g, photon.flux.b});
    if (!(flux > 0.0)) return;
    start(photon.ray, inside);
    throughput_ = photon.flux / flux;  // at most 1, for survives()
    pdf_ = 1.0;                        // direct light, which next-event estimation covers
    photon_ = {&stored, photon.light, flux};
    for (std::uint32_t vertices = 0; vertices < world_.max_vertices; ++vertices) {
        bool caught = false;
        const Hit hit = next_surface(random, caught);
        if (caught || ball_ || !hit.found) break;
        travel(hit);
        if (!meet(hit, random)) break;
        if (vertices >= kRouletteFrom && !survives(random)) break;
    }
    photon_ = {};
}

/// Stores the photon at a surface that is not smooth everywhere, unless next-event estimation covers its light.
void PathWalk::deposit(const Vertex& vertex) {
    if (pdf_ > 0.0) return;
    const double share = emitted_share(), flux = photon_.flux * share * range_share(*photon_.light, length_);
    Photon photon{vertex.hit.position, glm::vec3(world_.geometry.geometric_normal(vertex.hit)),
                  glm::vec3(ray_.direction), glm::vec3(flux * throughput_), float(share)};
    photon.crossing = vertex.hit.crossing;
    photon_.stored->push_back(photon);
}

/// Refracts or reflects a photon as the reversed eye path would be. Opaque coat and base colour therefore apply where
/// light leaves the solid.
bool PathWalk::cross_as_photon(const Vertex& vertex, const InterfaceBsdf& bsdf, Random& random) {
    const double glass = double(transmission(world_.scene, vertex.material, vertex.attributes));
    const bool coated = glass < 1.0 && vertex.hit.crossing.sense == Sense::kEntering;
    if (coated || !bsdf.only_mirrors()) deposit(vertex);
    if (coated) {
        throughput_ *= 2.0;
        if (random.next() < 0.5) {
            throughput_ *= 1.0 - glass;
            return scatter(vertex, opaque_bsdf(vertex), random);
        }
    }
    if (!scatter(vertex, bsdf, random)) return false;
    const auto& [object, triangle, sense, shell] = vertex.hit.crossing;
    if (world_.geometry.sense(object, triangle, ray_.direction) == Sense::kLeaving) throughput_ *= glass;
    return true;
}

/// Correction of interpolated normals for photons, which travel opposite to eye paths (Veach 1997, section 5.3).
double PathWalk::adjoint_weight(const Vertex& vertex, const glm::dvec3& wi, const glm::dvec3& wo) const {
    const glm::dvec3 flat = world_.geometry.geometric_normal(vertex.hit);
    const double weight = std::abs(glm::dot(wi, vertex.normal) * glm::dot(wo, flat)) /
                          std::abs(glm::dot(wi, flat) * glm::dot(wo, vertex.normal));
    return std::isfinite(weight) ? weight : 0.0;
}

/// Adds the light of the photons around a scattering surface.
void PathWalk::add_photons(const Vertex& vertex, const Bsdf& bsdf, const Facing& facing, Random& random) {
    const glm::dvec3 normal = world_.geometry.geometric_normal(vertex.hit);
    glm::dvec3 sum(0.0);
    world_.photons->for_each_near(vertex.hit.position, normal, [&](const Photon& photon) {
        const glm::dvec3 towards = -glm::normalize(glm::dvec3(photon.direction));
        const double cosine = std::abs(glm::dot(towards, normal));
        const BsdfValue bsdf_value = value_towards(vertex, bsdf, facing, towards, random);
        if (bsdf_value.pdf > 0.0 && cosine > 0.0)
            sum += bsdf_value.value * glm::dvec3(photon.flux) / (cosine * double(photon.area));
    });
    receive(part_through(LightPart::kCaustic), throughput_ * sum);
}

}  // namespace pellucid::reference
