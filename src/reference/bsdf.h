#pragma once

// How surfaces scatter light, in a frame whose z axis is the shading normal on the viewer's side. `wo`
// points to the viewer (wo.z > 0), `wi` to where the light comes from; both are unit and point away
// from the surface.
//
// Radiance is carried divided by the square of the index of refraction it travels in (basic radiance,
// Nicodemus 1963), which refraction leaves as it is, so the factor eta^2 of a BTDF appears nowhere.
// What ends in air is the same either way. What a surface inside glass emits, or a lamp in there sends
// out, is hence understood as what is seen of it from outside, less the losses on the way: the light
// in the glass itself is n^2 times as strong.

#include "reference/bsdf_sample.h"
#include "reference/finished_bsdf.h"
#include "reference/microfacet.h"
#include "reference/random.h"
#include "reference/rough_interface.h"

#include <glm/glm.hpp>

#include <optional>
#include <variant>

namespace pellucid::reference {

/// An opaque surface: the metallic-roughness material of glTF 2.0 (appendix B) with GGX reflection. The
/// appendix adds its two layers such that white at grazing angles reflects nearly twice what it gets;
/// here the diffuse layer gets what the coat lets in and sends out of it what the coat lets out
/// (Kelemen & Szirmay-Kalos, "A microfacet based coupled specular-matte BRDF model", 2001).
class OpaqueBsdf {
public:
    /// `base` and `metallic` 0..1, `roughness` perceptual, 0..1; `ior` 1: no coat.
    OpaqueBsdf(const glm::dvec3& base, double metallic, double roughness, double ior);
    /// True if evaluate() is 0 for all directions.
    bool only_mirrors() const { return facets_.smooth() && diffuse_ == glm::dvec3(0.0); }
    BsdfValue evaluate(const glm::dvec3& wo, const glm::dvec3& wi, Random& random) const;
    std::optional<BsdfSample> sample(const glm::dvec3& wo, Random& random) const;

private:
    glm::dvec3 reflectance(double cos_theta) const;
    double coat(double cos_theta) const;
    double mirror_share(const glm::dvec3& wo) const;

    Microfacets facets_;
    glm::dvec3 diffuse_{0.0};    ///< albedo under the coat
    glm::dvec3 at_normal_{0.0};  ///< reflectance head-on
    double coat_at_normal_ = 0.0;
};

/// The boundary of two dielectrics. Without a tint it loses no light, however rough: light that one facet
/// sends to another goes on from there (see rough_interface.h).
class InterfaceBsdf {
public:
    /// Indices of refraction on the viewer's and on the other side. `tint` multiplies light that ends on the
    /// other side, once, however often it crossed the microsurface.
    InterfaceBsdf(double n_o, double n_i, double roughness, const glm::dvec3& tint);
    bool only_mirrors() const { return facets_.smooth(); }
    BsdfValue evaluate(const glm::dvec3& wo, const glm::dvec3& wi, Random& random) const;
    std::optional<BsdfSample> sample(const glm::dvec3& wo, Random& random) const;

private:
    Microfacets facets_;
    double n_o_ = 1.0, n_i_ = 1.0;
    RoughInterface rough_;  ///< for facets that are not smooth
    glm::dvec3 tint_{1.0};
};

/// A thin-walled pane: both faces and all reflections between them, nothing bent. A rough pane scatters light
/// as facets do that reflect everything, all reflections between them included. It reflects a share of the
/// result, by the angle to the half vector of wo and wi, and transmits the rest, mirrored to the other side.
class PaneBsdf {
public:
    /// `tint` multiplies what is transmitted.
    PaneBsdf(double ior, double roughness, const glm::dvec3& tint);
    bool only_mirrors() const { return facets_.smooth(); }
    /// Share of light that a smooth pane lets straight through.
    glm::dvec3 straight_through(double cos_theta_o) const { return tint_ * (1.0 - reflectance(cos_theta_o)); }
    BsdfValue evaluate(const glm::dvec3& wo, const glm::dvec3& wi, Random& random) const;
    std::optional<BsdfSample> sample(const glm::dvec3& wo, Random& random) const;

private:
    double reflectance(double cos_theta_o) const;
    double rough_share(const glm::dvec3& wo, const glm::dvec3& wi) const;

    Microfacets facets_;
    RoughInterface rough_;  ///< for facets that are not smooth
    double ior_ = 1.5;
    glm::dvec3 tint_{1.0};
};

using Bsdf = std::variant<OpaqueBsdf, FinishedBsdf, InterfaceBsdf, PaneBsdf>;

}  // namespace pellucid::reference
