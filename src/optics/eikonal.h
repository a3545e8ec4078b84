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

}  // namespace pellucid
