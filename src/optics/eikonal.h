#pragma once

// Light rays where the index of refraction n(x) varies: the ray equation d/ds (n dx/ds) = grad n, integrated step by
// step. Ihrke, Ziegler, Tevs, Theobalt, Magnor, Seidel: Eikonal Rendering: Efficient Light Transport in Refractive
// Objects, ACM Transactions on Graphics 26(3), 2007, sections 4.1 and 4.2 and the appendix. Twin of eikonal.glsl.
//
// The state is a position x and v = n dx/ds, the gradient of the optical path, so that |v| = n. With steps of equal
// length in space dx/ds = v / n and dv/ds = grad n; with steps of equal optical time (length times n)
// dx/dt = v / n^2 and dv/dt = grad n / n. Total internal reflection needs no case of its own.
//
// A field is a function object: `IndexSample<Real> operator()(Vec3<Real> x) const`.

#include "optics/interface.h"

namespace pellucid {

/// The index at a place and its gradient, in 1 / the unit of positions.
template <class Real>
struct IndexSample {
    Vec3<Real> gradient;
    Real n;
};

template <class Real>
struct CurvedRay {
    Vec3<Real> x;
    Vec3<Real> v;  ///< n times the unit direction
};

/// The ray that starts at x in a unit direction.
template <class Real, class Field>
CurvedRay<Real> start_ray(const Field& field, Vec3<Real> x, Vec3<Real> direction) {
    return {x, field(x).n * direction};
}

/// How a step is counted.
enum class RayStep { kSpace, kTime };

/// dx and dv by one unit of space (length) or optical time.
template <RayStep kStep, class Real, class Field>
CurvedRay<Real> ray_slope(const Field& field, const CurvedRay<Real>& ray) {
    const IndexSample<Real> at = field(ray.x);
    if constexpr (kStep == RayStep::kSpace) return {ray.v / at.n, at.gradient};
    return {ray.v / (at.n * at.n), at.gradient / at.n};
}

template <class Real>
CurvedRay<Real> advanced(const CurvedRay<Real>& ray, std::type_identity_t<Real> step, const CurvedRay<Real>& slope) {
    return {ray.x + step * slope.x, ray.v + step * slope.v};
}

/// First order: the error at the end of a ray of given length falls with the step.
template <RayStep kStep = RayStep::kSpace, class Real, class Field>
CurvedRay<Real> euler_step(const Field& field, const CurvedRay<Real>& ray, std::type_identity_t<Real> step) {
    return advanced(ray, step, ray_slope<kStep>(field, ray));
}

/// The classical method of Runge and Kutta, of fourth order where n has five derivatives.
template <RayStep kStep = RayStep::kSpace, class Real, class Field>
CurvedRay<Real> rk4_step(const Field& field, const CurvedRay<Real>& ray, std::type_identity_t<Real> step) {
    const CurvedRay<Real> a = ray_slope<kStep>(field, ray);
    const CurvedRay<Real> b = ray_slope<kStep>(field, advanced(ray, step / 2, a));
    const CurvedRay<Real> c = ray_slope<kStep>(field, advanced(ray, step / 2, b));
    const CurvedRay<Real> d = ray_slope<kStep>(field, advanced(ray, step, c));
    const Real third = step / 3, sixth = step / 6;
    return {ray.x + sixth * (a.x + d.x) + third * (b.x + c.x), ray.v + sixth * (a.v + d.v) + third * (b.v + c.v)};
}

/// dv by one unit of sigma, where ds = n dsigma: with it dx/dsigma = v and dv/dsigma = grad(n^2) / 2. That is a particle
/// in a force field, on which v has no influence (Sharma, Kumar & Ghatak, "Tracing rays through graded-index media: a
/// new method", Applied Optics 21(6), 1982).
template <class Real, class Field>
Vec3<Real> ray_force(const Field& field, const Vec3<Real>& x) {
    const IndexSample<Real> at = field(x);
    return at.n * at.gradient;
}

/// Drift, kick, drift: of second order, with one look at the field. `length` in space.
template <class Real, class Field>
CurvedRay<Real> leapfrog_step(const Field& field, const CurvedRay<Real>& ray, std::type_identity_t<Real> length) {
    const Real step = length / glm::length(ray.v);
    const Vec3<Real> middle = ray.x + step / 2 * ray.v;
    const Vec3<Real> v = ray.v + step * ray_force<Real>(field, middle);
    return {middle + step / 2 * v, v};
}

/// Nystrom's method for second derivatives: of fourth order, with three looks. `length` in space.
template <class Real, class Field>
CurvedRay<Real> nystrom_step(const Field& field, const CurvedRay<Real>& ray, std::type_identity_t<Real> length) {
    const Real step = length / glm::length(ray.v), half = step / 2;
    const Vec3<Real> a = ray_force<Real>(field, ray.x);
    const Vec3<Real> b = ray_force<Real>(field, ray.x + half * ray.v + half * half / 2 * a);
    const Vec3<Real> c = ray_force<Real>(field, ray.x + step * ray.v + step * half * b);
    return {ray.x + step * ray.v + step * step / 6 * (a + Real(2) * b), ray.v + step / 6 * (a + Real(4) * b + c)};
}

}  // namespace pellucid
