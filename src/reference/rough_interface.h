#pragma once

// Scattering by a rough surface with all reflections and refractions between its microfacets: Heitz,
// Hanika, d'Eon & Dachsbacher, "Multiple-scattering microfacet BSDFs with the Smith model", 2016.
//
// Light takes a random walk on the microsurface, above and below it, until it leaves on one side. In the Smith model
// the height and the normal of a facet are independent of each other and of all other facets. The walk therefore
// stores one height. Only the cumulative distribution C(h) of heights matters, so `level` = C(h), in 0..1, replaces
// the height. Seen from the other side, a facet lies at 1 - level.
//
// Directions are as in bsdf.h. Densities are per steradian and belong to basic radiance.

#include "reference/dielectric.h"
#include "reference/microfacet.h"
#include "reference/random.h"

#include <glm/glm.hpp>

namespace pellucid::reference {

class RoughInterface {
public:
    /// A boundary of two dielectrics, n_o on the viewer's side. The facets must not be smooth.
    RoughInterface(const Microfacets& facets, double n_o, double n_i) : facets_(facets), n_o_(n_o), n_i_(n_i) {}
    /// Facets that reflect all light.
    static RoughInterface mirrors(const Microfacets& facets);

    /// Samples the direction in which light from wo (wo.z > 0) leaves. Its density is the BSDF times
    /// |cos theta_i|, so that a sample weighs 1.
    glm::dvec3 sample(const glm::dvec3& wo, Random& random) const;

    /// Part of that density from walks of one facet.
    double single(const glm::dvec3& wo, const glm::dvec3& wi) const;
    /// Part of that density from walks of two or more facets: an unbiased estimate by random walks from both ends.
    double multiple(const glm::dvec3& wo, const glm::dvec3& wi, Random& random) const;

    /// Substitute for the density of sample() in weights of multiple importance sampling, which may be any positive
    /// function. It is deliberately larger than the density of multiple(). The estimate of multiple() varies more for
    /// narrower lobes. Light sampling should therefore choose a direction outside the lobe of single() only if its own
    /// density is above 1 / (pi alpha).
    double mis_density(double single) const;

private:
    /// A ray on the microsurface, in a frame whose z axis is the macroscopic normal on the ray's side.
    struct Ray {
        glm::dvec3 direction{0.0};  ///< direction of travel
        double level = 1.0;         ///< 0..1; 1 is above all facets
        bool outside = true;        ///< true on the viewer's side
    };
    Incidence at_facet(const Ray& ray, const glm::dvec3& m) const;
    bool reaches_facet(Ray& ray, Random& random) const;
    void scatter(Ray& ray, Random& random) const;
    double reflected_density(const Ray& ray, const glm::dvec3& w) const;
    double refracted_density(const Ray& ray, const glm::dvec3& w) const;
    double leaving_density(const Ray& ray, const glm::dvec3& wi) const;
    double walk_towards(const glm::dvec3& from, const glm::dvec3& to, double reversal, Random& random) const;

    Microfacets facets_;
    double n_o_ = 1.0, n_i_ = 1.0;
    bool mirrors_ = false;
};

}  // namespace pellucid::reference
