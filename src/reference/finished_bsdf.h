#pragma once

// An opaque surface with what extensions of glTF add: see pellucid::Finish. Directions as in bsdf.h.

#include "reference/bsdf_sample.h"
#include "reference/microfacet.h"
#include "reference/random.h"
#include "reference/stretched_facets.h"

#include <glm/glm.hpp>

#include <optional>

namespace pellucid::reference {

/// What textures and factors say of a point of such a surface.
struct FinishedPoint {
    glm::dvec3 base{1.0};  ///< 0..1
    double metallic = 0.0, roughness = 0.0, ior = 1.5;
    double coat = 0.0, coat_roughness = 0.0;
    glm::dvec3 coat_normal{0.0, 0.0, 1.0};  ///< unit, in the frame of the shading normal
    glm::dvec3 sheen{0.0};
    double sheen_roughness = 0.0;
    double specular = 1.0;
    glm::dvec3 specular_color{1.0};
    double film = 0.0, film_ior = 1.3, film_thickness_nm = 400.0;
    double anisotropy = 0.0;
    glm::dvec2 along{1.0, 0.0};  ///< unit, direction of anisotropy in the frame of the shading normal
};

/// Layers from the outside: a clear coat of index 1.5, which takes its Fresnel reflectance in the direction of the viewer
/// from what is below, as KHR_materials_clearcoat has it; fibres (Estevez & Kulla, "Production friendly microfacet sheen
/// BRDF", 2017), which take their albedo (KHR_materials_sheen); and the metallic-roughness surface of OpaqueBsdf, whose
/// boundary may reflect less, coloured or along a direction (KHR_materials_specular, _iridescence, _anisotropy).
class FinishedBsdf {
public:
    explicit FinishedBsdf(const FinishedPoint& point);
    /// True if evaluate() is 0 for all directions.
    bool only_mirrors() const;
    BsdfValue evaluate(const glm::dvec3& wo, const glm::dvec3& wi, Random& random) const;
    std::optional<BsdfSample> sample(const glm::dvec3& wo, Random& random) const;

private:
    /// How often sample() chooses each layer: about their shares of the light.
    struct Shares {
        double coat, fibres, facets, diffuse;
    };
    Shares shares(const glm::dvec3& wo) const;
    double coat_reflectance(double cos_theta) const;
    double coat_cosine(const glm::dvec3& w) const { return glm::dot(w, point_.coat_normal); }
    double below_coat(const glm::dvec3& wo) const { return 1.0 - coat_reflectance(coat_cosine(wo)); }
    double below_fibres(const glm::dvec3& wo) const;
    glm::dvec3 reflectance(double cos_theta) const;
    double boundary(double cos_theta) const;
    glm::dvec3 to_stretched(const glm::dvec3& w) const;
    glm::dvec3 from_stretched(const glm::dvec3& w) const;

    FinishedPoint point_;
    Microfacets coat_facets_;
    glm::dmat3 coat_frame_{1.0};  ///< z: the coat's normal
    bool smooth_ = false;         ///< the base's facets are a mirror
    StretchedFacets facets_;
    glm::dvec3 diffuse_{0.0}, at_normal_{0.0}, at_grazing_{0.0};
    double boundary_at_normal_ = 0.0, boundary_at_grazing_ = 0.0, mean_boundary_ = 0.0;
};

}  // namespace pellucid::reference
