#include "reference/bsdf.h"

#include "reference/dielectric.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid::reference {
namespace {

using std::numbers::pi;

Microfacets facets_of(double roughness) { return {roughness * roughness}; }

/// Schlick, "An inexpensive BRDF model for physically-based rendering", 1994.
double schlick_weight(double cos_theta) {
    const double grazing = std::clamp(1.0 - cos_theta, 0.0, 1.0);
    return grazing * grazing * grazing * grazing * grazing;
}

glm::dvec3 mirrored(const glm::dvec3& wo) { return {-wo.x, -wo.y, wo.z}; }
glm::dvec3 mirrored(const glm::dvec3& wo, const glm::dvec3& m) { return 2.0 * glm::dot(wo, m) * m - wo; }
glm::dvec3 to_other_side(const glm::dvec3& w) { return {w.x, w.y, -w.z}; }

glm::dvec3 cosine_weighted(const glm::dvec2& u) {
    const double radius = std::sqrt(u.x), angle = 2.0 * pi * u.y;
    return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(1.0 - u.x, 0.0))};
}

/// Reflection by fully reflecting facets: BRDF times cos theta_i, and the density of wi under visible-normal sampling.
/// wo and wi lie on the same side.
struct FacetReflection {
    glm::dvec3 m{0.0};  ///< normal of the facets
    double value = 0.0;
    double pdf = 0.0;
};
FacetReflection reflect_by_facets(const Microfacets& facets, const glm::dvec3& wo, const glm::dvec3& wi) {
    const glm::dvec3 m = glm::normalize(wo + wi);
    const double density = facets.density(m) / (4.0 * wo.z);
    return {m, density * facets.masking_shadowing(wo, wi), density * facets.masking(wo)};
}

}  // namespace

OpaqueBsdf::OpaqueBsdf(const glm::dvec3& base, double metallic, double roughness, double ior)
    : facets_(facets_of(roughness)), diffuse_((1.0 - metallic) * base) {
    const double f0 = (ior - 1.0) / (ior + 1.0);
    coat_at_normal_ = f0 * f0;
    at_normal_ = glm::mix(glm::dvec3(coat_at_normal_), base, metallic);
}

glm::dvec3 OpaqueBsdf::reflectance(double cos_theta) const {
    // Without reflection at normal incidence there is no boundary, hence none at grazing angles.
    const glm::dvec3 grazing = glm::dvec3(glm::greaterThan(at_normal_, glm::dvec3(0.0)));
    return glm::mix(at_normal_, grazing, schlick_weight(cos_theta));
}

double OpaqueBsdf::coat(double cos_theta) const {
    return coat_at_normal_ > 0.0 ? glm::mix(coat_at_normal_, 1.0, schlick_weight(cos_theta)) : 0.0;
}

/// Probability that sample() chooses the coat: approximately its share of the light.
double OpaqueBsdf::mirror_share(const glm::dvec3& wo) const {
    const glm::dvec3 mirror = reflectance(wo.z), diffuse = diffuse_ * (1.0 - coat(wo.z));
    const double a = std::max({mirror.r, mirror.g, mirror.b}), b = std::max({diffuse.r, diffuse.g, diffuse.b});
    return a > 0.0 ? a / (a + b) : 0.0;
}

BsdfValue OpaqueBsdf::evaluate(const glm::dvec3& wo, const glm::dvec3& wi, Random&) const {
    if (wo.z <= 0.0 || wi.z <= 0.0) return {};
    const double share = mirror_share(wo);
    // Mean reflectance of the coat for diffuse light. Light that it reflects back is scattered once more.
    const double mean_coat = coat_at_normal_ > 0.0 ? coat_at_normal_ + (1.0 - coat_at_normal_) / 21.0 : 0.0;
    const double passes = (1.0 - coat(wo.z)) * (1.0 - coat(wi.z)) / (1.0 - mean_coat);
    BsdfValue result{diffuse_ * (passes * wi.z / pi), (1.0 - share) * wi.z / pi};
    if (!facets_.smooth()) {
        const FacetReflection facets = reflect_by_facets(facets_, wo, wi);
        result.value += reflectance(glm::dot(wo, facets.m)) * facets.value;
        result.pdf += share * facets.pdf;
    }
    return result;
}

std::optional<BsdfSample> OpaqueBsdf::sample(const glm::dvec3& wo, Random& random) const {
    const double share = mirror_share(wo);
    BsdfSample sample;
    if (random.next() < share) {
        if (facets_.smooth()) {
            sample.wi = mirrored(wo);
            sample.weight = reflectance(wo.z) / share;
            sample.mirror = true;
            return sample;
        }
        sample.wi = mirrored(wo, facets_.sample_visible(wo, random.next2()));
    } else {
        sample.wi = cosine_weighted(random.next2());
    }
    const BsdfValue value = evaluate(wo, sample.wi, random);
    if (!(value.pdf > 0.0)) return std::nullopt;  // the direction would be blocked by another facet
    sample.weight = value.value / value.pdf;
    sample.pdf = value.pdf;
    return sample;
}

InterfaceBsdf::InterfaceBsdf(double n_o, double n_i, double roughness, const glm::dvec3& tint)
    : facets_(facets_of(n_o == n_i ? 0.0 : roughness)), n_o_(n_o), n_i_(n_i), rough_(facets_, n_o, n_i), tint_(tint) {}

BsdfValue InterfaceBsdf::evaluate(const glm::dvec3& wo, const glm::dvec3& wi, Random& random) const {
    if (facets_.smooth() || wo.z <= 0.0 || wi.z == 0.0) return {};
    const double single = rough_.single(wo, wi);
    const double value = single + rough_.multiple(wo, wi, random);
    return {wi.z > 0.0 ? glm::dvec3(value) : tint_ * value, rough_.mis_density(single)};
}

std::optional<BsdfSample> InterfaceBsdf::sample(const glm::dvec3& wo, Random& random) const {
    BsdfSample sample;
    if (facets_.smooth()) {
        const glm::dvec3 n(0.0, 0.0, 1.0);
        const Incidence in = incidence(-wo, n, n_o_, n_i_);
        const bool reflects = random.next() < in.reflectance;
        sample.wi = reflects ? reflected(-wo, n, in) : refracted(-wo, n, n_o_, n_i_, in);
        sample.weight = reflects ? glm::dvec3(1.0) : tint_;
        sample.mirror = true;
        return sample;
    }
    sample.wi = rough_.sample(wo, random);
    sample.weight = sample.wi.z > 0.0 ? glm::dvec3(1.0) : tint_;
    sample.pdf = rough_.mis_density(rough_.single(wo, sample.wi));
    return sample;
}

PaneBsdf::PaneBsdf(double ior, double roughness, const glm::dvec3& tint)
    : facets_(facets_of(roughness)), rough_(RoughInterface::mirrors(facets_)), ior_(ior), tint_(tint) {}

/// 2 F / (1 + F): series of reflections between the pane's two faces.
double PaneBsdf::reflectance(double cos_theta_o) const {
    const double f = incidence({0.0, 0.0, -cos_theta_o}, {0.0, 0.0, 1.0}, 1.0, ior_).reflectance;
    return 2.0 * f / (1.0 + f);
}

/// Share of the light scattered from wo to wi, both on one side, that stays on that side. It is symmetric in wo and
/// wi, so the pane is reciprocal.
double PaneBsdf::rough_share(const glm::dvec3& wo, const glm::dvec3& wi) const {
    return reflectance(glm::dot(wo, glm::normalize(wo + wi)));
}

BsdfValue PaneBsdf::evaluate(const glm::dvec3& wo, const glm::dvec3& wi, Random& random) const {
    if (facets_.smooth() || wo.z <= 0.0 || wi.z == 0.0) return {};
    const glm::dvec3 above = wi.z > 0.0 ? wi : to_other_side(wi);
    const double r = rough_share(wo, above), share = wi.z > 0.0 ? r : 1.0 - r;
    const double single = rough_.single(wo, above);
    const double value = share * (single + rough_.multiple(wo, above, random));
    return {wi.z > 0.0 ? glm::dvec3(value) : tint_ * value, rough_.mis_density(share * single)};
}

std::optional<BsdfSample> PaneBsdf::sample(const glm::dvec3& wo, Random& random) const {
    BsdfSample sample;
    sample.wi = facets_.smooth() ? mirrored(wo) : rough_.sample(wo, random);
    const double r = rough_share(wo, sample.wi);
    const bool reflects = random.next() < r;
    sample.weight = reflects ? glm::dvec3(1.0) : tint_;
    sample.mirror = facets_.smooth();
    if (!sample.mirror) sample.pdf = rough_.mis_density((reflects ? r : 1.0 - r) * rough_.single(wo, sample.wi));
    if (!reflects) sample.wi = to_other_side(sample.wi);
    return sample;
}

}  // namespace pellucid::reference
