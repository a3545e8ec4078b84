#include "reference/rough_interface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid::reference {
namespace {

/// Bound on the facets of one walk, against endless loops by rounding. The longest of 3.6e7 walks visited 22 facets,
/// for indices of 1.2 to 2.42 and roughnesses of 0.2 to 1.
constexpr int kMaxFacets = 100000;
/// Lowest level, about one rounding unit of 1. No walk could return from level 0.
constexpr double kLowest = 1e-16;

glm::dvec3 to_other_side(const glm::dvec3& w) { return {w.x, w.y, -w.z}; }

/// std::lgamma() writes the sign to a variable that all threads share.
double log_gamma(double x) {
    int sign = 0;
    return ::lgamma_r(x, &sign);
}

/// Euler's beta function. Both arguments are at least 1.
double beta(double a, double b) { return std::exp(log_gamma(a) + log_gamma(b) - log_gamma(a + b)); }

}  // namespace

RoughInterface RoughInterface::mirrors(const Microfacets& facets) {
    RoughInterface surface(facets, 1.0, 1.0);
    surface.mirrors_ = true;
    return surface;
}

Incidence RoughInterface::at_facet(const Ray& ray, const glm::dvec3& m) const {
    Incidence in = ray.outside ? incidence(ray.direction, m, n_o_, n_i_) : incidence(ray.direction, m, n_i_, n_o_);
    if (mirrors_) in.reflectance = 1.0;
    return in;
}

/// Moves the ray to the next facet. Returns false if the ray leaves the microsurface instead.
///
/// Smith's probability of a free path in direction w: (c / d)^lambda(w) up from level c to d, and (d / c)^(1 +
/// lambda(w)) down from c to d.
bool RoughInterface::reaches_facet(Ray& ray, Random& random) const {
    const double clear = 1.0 - random.next();  // probability of a free path, 0 < clear <= 1
    const double lambda = facets_.lambda(ray.direction);
    if (ray.direction.z > 0.0) {
        if (clear <= std::pow(ray.level, lambda)) return false;
        ray.level *= std::pow(clear, -1.0 / lambda);
    } else {
        ray.level *= std::pow(clear, 1.0 / (1.0 + lambda));
    }
    ray.level = std::clamp(ray.level, kLowest, 1.0);
    return true;
}

/// Reflects or refracts the ray at a facet visible to it.
void RoughInterface::scatter(Ray& ray, Random& random) const {
    const glm::dvec3 m = facets_.sample_visible(-ray.direction, random.next2());
    const Incidence in = at_facet(ray, m);
    if (random.next() < in.reflectance) {
        ray.direction = reflected(ray.direction, m, in);
        return;
    }
    const double n_here = ray.outside ? n_o_ : n_i_, n_there = ray.outside ? n_i_ : n_o_;
    ray.direction = to_other_side(refracted(ray.direction, m, n_here, n_there, in));
    ray.level = std::max(1.0 - ray.level, kLowest);
    ray.outside = !ray.outside;
}

glm::dvec3 RoughInterface::sample(const glm::dvec3& wo, Random& random) const {
    Ray ray{-wo};
    for (int facet = 0; facet < kMaxFacets && reaches_facet(ray, random); ++facet) scatter(ray, random);
    ray.direction.z = std::abs(ray.direction.z);  // a walk cut by the bound can point at the surface
    return ray.outside ? ray.direction : to_other_side(ray.direction);
}

/// Density with which the ray's next facet reflects it to w.
double RoughInterface::reflected_density(const Ray& ray, const glm::dvec3& w) const {
    const glm::dvec3 sum = w - ray.direction;
    if (!(sum.z > 0.0)) return 0.0;
    const glm::dvec3 m = glm::normalize(sum);
    return at_facet(ray, m).reflectance * facets_.density(m) / (4.0 * facets_.projected_area(-ray.direction));
}

/// Density with which the ray's next facet refracts it to w: Walter 2007, equation 16 for the facet and 17 for
/// its density.
double RoughInterface::refracted_density(const Ray& ray, const glm::dvec3& w) const {
    const double eta = ray.outside ? n_o_ / n_i_ : n_i_ / n_o_;
    const glm::dvec3 sum = w - eta * ray.direction;
    const double length = glm::length(sum);
    if (mirrors_ || !(length > 0.0)) return 0.0;
    const glm::dvec3 m = sum.z < 0.0 ? -sum / length : sum / length;
    const double cos_here = -glm::dot(ray.direction, m), cos_there = glm::dot(w, m);
    if (cos_here <= 0.0 || cos_there >= 0.0) return 0.0;
    const double stretch = eta * cos_here + cos_there;
    const double transmitted = 1.0 - at_facet(ray, m).reflectance;
    return transmitted * facets_.density(m) * cos_here * -cos_there /
           (facets_.projected_area(-ray.direction) * stretch * stretch);
}

double RoughInterface::single(const glm::dvec3& wo, const glm::dvec3& wi) const {
    const Ray ray{-wo};
    // The first facet's level c has the density (1 + lambda_o) c^lambda_o. The light leaves from there with
    // the probability c^lambda_i, on the other side (1 - c)^lambda_i. Both integrals have a closed form.
    const double lambda_o = facets_.lambda(wo), lambda_i = facets_.lambda(wi);
    if (wi.z > 0.0) return reflected_density(ray, wi) * (1.0 + lambda_o) / (1.0 + lambda_o + lambda_i);
    // Near the horizon lgamma() cancels. Directions within 1e-7 alpha of it get no light that matters.
    constexpr double kMost = 1e7;
    if (std::max(lambda_o, lambda_i) > kMost) return 0.0;
    return refracted_density(ray, wi) * (1.0 + lambda_o) * beta(1.0 + lambda_o, 1.0 + lambda_i);
}

/// Density with which the ray's next facet, at the ray's level, sends it out of the microsurface to wi.
double RoughInterface::leaving_density(const Ray& ray, const glm::dvec3& wi) const {
    const glm::dvec3 w = ray.outside ? wi : to_other_side(wi);
    const double lambda = facets_.lambda(wi);
    if (w.z > 0.0) return reflected_density(ray, w) * std::pow(ray.level, lambda);
    return refracted_density(ray, w) * std::pow(1.0 - ray.level, lambda);
}

/// Estimates the share of walks from `from`, over two or more facets, whose last facet sends the light to `to`.
///
/// The same paths can be sampled from the other end. Both estimates are combined by the balance heuristic, path
/// by path (Veach 1997, section 9.2.2). The two densities of a path differ in its ends alone: this walk has not
/// sampled the last facet and the other walk has not sampled the first. `reversal` is the ratio of the density
/// from -> to and the density to -> from.
double RoughInterface::walk_towards(const glm::dvec3& from, const glm::dvec3& to, double reversal,
                                    Random& random) const {
    Ray ray = from.z > 0.0 ? Ray{-from} : Ray{to_other_side(-from), 1.0, false};
    double sum = 0.0, back = 0.0;
    for (int facet = 0; facet < kMaxFacets && reaches_facet(ray, random); ++facet) {
        if (facet > 0) {
            const double there = leaving_density(ray, to);
            if (there > 0.0) sum += there * back / (there + back);
        }
        scatter(ray, random);
        if (facet == 0) back = reversal * leaving_density({-ray.direction, ray.level, ray.outside}, from);
    }
    return sum;
}

double RoughInterface::multiple(const glm::dvec3& wo, const glm::dvec3& wi, Random& random) const {
    const double n = wi.z > 0.0 ? 1.0 : n_i_ / n_o_;
    const double reversal = n * n * std::abs(wi.z) / wo.z;
    return walk_towards(wo, wi, reversal, random) + reversal * walk_towards(wi, wo, 1.0 / reversal, random);
}

double RoughInterface::mis_density(double single) const { return single + 1.0 / (std::numbers::pi * facets_.alpha); }

}  // namespace pellucid::reference
