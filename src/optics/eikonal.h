#pragma once

// Light rays in a varying index of refraction n(x): step-by-step integration of the ray equation d/ds (n dx/ds) = grad
// n. Ihrke, Ziegler, Tevs, Theobalt, Magnor, Seidel: Eikonal Rendering: Efficient Light Transport in Refractive
// Objects, ACM Transactions on Graphics 26(3), 2007, sections 4.1 and 4.2 and the appendix. Twin of eikonal.glsl.
//
// The state is a position x and v = n dx/ds, the gradient of the optical path, so |v| = n. With steps of equal length,
// dx/ds = v / n and dv/ds = grad n. With steps of equal optical time (length times n), dx/dt = v / n^2 and dv/dt =
// grad n / n. Total internal reflection needs no special case.
//
// A field is a function object: `IndexSample<Real> operator()(Vec3<Real> x) const`.

#include "optics/interface.h"

namespace pellucid {

/// The index at a position, and its gradient per unit of position.
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

/// The ray from x in a unit direction.
template <class Real, class Field>
CurvedRay<Real> start_ray(const Field& field, Vec3<Real> x, Vec3<Real> direction) {
    return {x, field(x).n * direction};
}

/// Unit of a step: length, or optical time.
enum class RayStep { kSpace, kTime };

/// Derivatives of x and v by length or optical time.
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

/// First order: the error at the end of a ray of given length is proportional to the step.
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

/// dv / dsigma, where ds = n dsigma: then dx/dsigma = v and dv/dsigma = grad(n^2) / 2. This describes a particle in a
/// force field that does not depend on v (Sharma, Kumar & Ghatak, "Tracing rays through graded-index media: a new
/// method", Applied Optics 21(6), 1982).
template <class Real, class Field>
Vec3<Real> ray_force(const Field& field, const Vec3<Real>& x) {
    const IndexSample<Real> at = field(x);
    return at.n * at.gradient;
}

/// Drift, kick, drift: second order, with one field evaluation. `length`: of the step in space.
template <class Real, class Field>
CurvedRay<Real> leapfrog_step(const Field& field, const CurvedRay<Real>& ray, std::type_identity_t<Real> length) {
    const Real step = length / glm::length(ray.v);
    const Vec3<Real> middle = ray.x + step / 2 * ray.v;
    const Vec3<Real> v = ray.v + step * ray_force<Real>(field, middle);
    return {middle + step / 2 * v, v};
}

/// Nystrom's method for second derivatives: fourth order, with three field evaluations. `length`: of the step in
/// space.
template <class Real, class Field>
CurvedRay<Real> nystrom_step(const Field& field, const CurvedRay<Real>& ray, std::type_identity_t<Real> length) {
    const Real step = length / glm::length(ray.v), half = step / 2;
    const Vec3<Real> a = ray_force<Real>(field, ray.x);
    const Vec3<Real> b = ray_force<Real>(field, ray.x + half * ray.v + half * half / 2 * a);
    const Vec3<Real> c = ray_force<Real>(field, ray.x + step * ray.v + step * half * b);
    return {ray.x + step * ray.v + step * step / 6 * (a + Real(2) * b), ray.v + step / 6 * (a + Real(4) * b + c)};
}

}  // namespace pellucid
