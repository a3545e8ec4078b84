#include "reference/finished_bsdf.h"

#include "reference/local_frame.h"
#include "reference/sheen.h"
#include "reference/thin_film.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid::reference {
namespace {

using std::numbers::pi;

constexpr double kCoatAtNormal = 0.04;    // of index 1.5
constexpr double kLeastStretched = 1e-3;  // width of facets across the direction of anisotropy

double schlick_weight(double cos_theta) {
    const double grazing = std::clamp(1.0 - cos_theta, 0.0, 1.0);
    return grazing * grazing * grazing * grazing * grazing;
}

double largest(const glm::dvec3& v) { return std::max({v.r, v.g, v.b}); }

glm::dvec3 mirrored(const glm::dvec3& wo, const glm::dvec3& m) { return 2.0 * glm::dot(wo, m) * m - wo; }

glm::dvec3 cosine_weighted(const glm::dvec2& u) {
    const double radius = std::sqrt(u.x), angle = 2.0 * pi * u.y;
    return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(1.0 - u.x, 0.0))};
}

}  // namespace

FinishedBsdf::FinishedBsdf(const FinishedPoint& point)
    : point_(point), coat_facets_{point.coat_roughness * point.coat_roughness},
      coat_frame_(world_from_local(point.coat_normal)), diffuse_((1.0 - point.metallic) * point.base) {
    const double alpha = point.roughness * point.roughness, stretch = point.anisotropy * point.anisotropy;
    facets_ = {glm::mix(alpha, 1.0, stretch), alpha};
    smooth_ = facets_.alpha_x < Microfacets::kSmooth && facets_.alpha_y < Microfacets::kSmooth;
    if (stretch > 0.0)
        facets_ = {std::max(facets_.alpha_x, kLeastStretched), std::max(facets_.alpha_y, kLeastStretched)};

    const double root = (point.ior - 1.0) / (point.ior + 1.0);
    const glm::dvec3 dielectric = point.specular * glm::min(root * root * point.specular_color, glm::dvec3(1.0));
    // Where there is no boundary nothing is reflected at grazing angles either.
    const double grazing = point.ior > 1.0 ? point.specular : 0.0;
    const glm::dvec3 metal(glm::greaterThan(point.base, glm::dvec3(0.0)));
    at_normal_ = glm::mix(dielectric, point.base, point.metallic);
    at_grazing_ = glm::mix(glm::dvec3(grazing), metal, point.metallic);
    boundary_at_normal_ = largest(dielectric);
    boundary_at_grazing_ = grazing;
    mean_boundary_ = boundary_at_normal_ + (boundary_at_grazing_ - boundary_at_normal_) / 21.0;
    if (point.film > 0.0) {
        // Over diffuse light: the middles of equal shares of it.
        constexpr int kSteps = 4;
        mean_boundary_ = 0.0;
        for (int i = 0; i < kSteps; ++i) mean_boundary_ += boundary(std::sqrt((i + 0.5) / kSteps)) / kSteps;
    }
}

glm::dvec3 FinishedBsdf::reflectance(double cos_theta) const {
    const glm::dvec3 plain = glm::mix(at_normal_, at_grazing_, schlick_weight(cos_theta));
    if (point_.film == 0.0) return plain;
    return glm::mix(plain, film_reflectance(cos_theta, point_.film_ior, point_.film_thickness_nm, at_normal_),
                    point_.film);
}

/// What the boundary over the diffuse layer reflects; it lets all colours through alike.
double FinishedBsdf::boundary(double cos_theta) const {
    const double plain = glm::mix(boundary_at_normal_, boundary_at_grazing_, schlick_weight(cos_theta));
    if (point_.film == 0.0 || point_.metallic == 1.0) return plain;
    const glm::dvec3 film =
        film_reflectance(cos_theta, point_.film_ior, point_.film_thickness_nm, glm::dvec3(boundary_at_normal_));
    return glm::mix(plain, largest(film), point_.film);
}

double FinishedBsdf::coat_reflectance(double cos_theta) const {
    return point_.coat * glm::mix(kCoatAtNormal, 1.0, schlick_weight(std::max(cos_theta, 0.0)));
}

double FinishedBsdf::below_fibres(const glm::dvec3& wo) const {
    if (point_.sheen == glm::dvec3(0.0)) return 1.0;
    return 1.0 - largest(point_.sheen) * std::min(sheen_albedo(wo.z, point_.sheen_roughness), 1.0);
}

bool FinishedBsdf::only_mirrors() const {
    return smooth_ && diffuse_ == glm::dvec3(0.0) && point_.sheen == glm::dvec3(0.0) &&
           (point_.coat == 0.0 || coat_facets_.smooth());
}

glm::dvec3 FinishedBsdf::to_stretched(const glm::dvec3& w) const {
    const glm::dvec2 a = point_.along;
    return {a.x * w.x + a.y * w.y, a.x * w.y - a.y * w.x, w.z};
}

glm::dvec3 FinishedBsdf::from_stretched(const glm::dvec3& w) const {
    const glm::dvec2 a = point_.along;
    return {a.x * w.x - a.y * w.y, a.y * w.x + a.x * w.y, w.z};
}

FinishedBsdf::Shares FinishedBsdf::shares(const glm::dvec3& wo) const {
    const double below = below_coat(wo), base = below * below_fibres(wo);
    Shares s{coat_cosine(wo) > 0.0 ? 1.0 - below : 0.0, below * largest(point_.sheen) * 0.5,
             base * largest(reflectance(wo.z)), base * largest(diffuse_) * (1.0 - boundary(wo.z))};
    const double sum = s.coat + s.fibres + s.facets + s.diffuse;
    if (!(sum > 0.0)) return {0.0, 0.0, 0.0, 1.0};
    return {s.coat / sum, s.fibres / sum, s.facets / sum, s.diffuse / sum};
}

BsdfValue FinishedBsdf::evaluate(const glm::dvec3& wo, const glm::dvec3& wi, Random&) const {
    if (wo.z <= 0.0 || wi.z <= 0.0) return {};
    const Shares share = shares(wo);
    const double below = below_coat(wo), base = below * below_fibres(wo);
    const double passes = (1.0 - boundary(wo.z)) * (1.0 - boundary(wi.z)) / (1.0 - std::min(mean_boundary_, 0.999));
    BsdfValue result{diffuse_ * (base * passes * wi.z / pi), (share.diffuse + share.fibres) * wi.z / pi};
    if (point_.sheen != glm::dvec3(0.0)) {
        const double most = std::max(sheen_albedo(wo.z, point_.sheen_roughness), 1.0);
        result.value += point_.sheen * (below * sheen(wo, wi, point_.sheen_roughness) * wi.z / most);
    }
    if (!smooth_) {
        const glm::dvec3 o = to_stretched(wo), i = to_stretched(wi), m = glm::normalize(o + i);
        const double density = facets_.density(m) / (4.0 * o.z);
        result.value += reflectance(glm::dot(o, m)) * (base * density * facets_.masking_shadowing(o, i));
        result.pdf += share.facets * density * facets_.masking(o);
    }
    const glm::dvec3 o = wo * coat_frame_, i = wi * coat_frame_;
    if (point_.coat > 0.0 && !coat_facets_.smooth() && o.z > 0.0 && i.z > 0.0) {
        const glm::dvec3 m = glm::normalize(o + i);
        const double density = coat_facets_.density(m) / (4.0 * o.z);
        result.value += coat_reflectance(glm::dot(o, m)) * density * coat_facets_.masking_shadowing(o, i);
        result.pdf += share.coat * density * coat_facets_.masking(o);
    }
    return result;
}

std::optional<BsdfSample> FinishedBsdf::sample(const glm::dvec3& wo, Random& random) const {
    const Shares share = shares(wo);
    const auto mirror = [&](const glm::dvec3& normal, const glm::dvec3& weight) {
        BsdfSample sample;
        sample.wi = mirrored(wo, normal);
        sample.weight = weight;
        sample.mirror = true;
        return sample.wi.z > 0.0 ? std::optional(sample) : std::nullopt;
    };
    BsdfSample sample;
    const double choice = random.next();
    if (choice < share.coat) {
        if (coat_facets_.smooth())
            return mirror(point_.coat_normal, glm::dvec3(coat_reflectance(coat_cosine(wo)) / share.coat));
        const glm::dvec3 o = wo * coat_frame_;
        sample.wi = coat_frame_ * mirrored(o, coat_facets_.sample_visible(o, random.next2()));
        // evaluate() has no coat there.
        if (glm::dot(sample.wi, point_.coat_normal) <= 0.0) return std::nullopt;
    } else if (choice < share.coat + share.facets) {
        if (smooth_)
            return mirror({0.0, 0.0, 1.0}, reflectance(wo.z) * (below_coat(wo) * below_fibres(wo) / share.facets));
        const glm::dvec3 o = to_stretched(wo);
        sample.wi = from_stretched(mirrored(o, facets_.sample_visible(o, random.next2())));
    } else {
        sample.wi = cosine_weighted(random.next2());
    }
    const BsdfValue value = evaluate(wo, sample.wi, random);
    if (!(value.pdf > 0.0)) return std::nullopt;  // light that the next facet would catch
    sample.weight = value.value / value.pdf;
    sample.pdf = value.pdf;
    return sample;
}

}  // namespace pellucid::reference
