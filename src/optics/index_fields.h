#pragma once

// Index fields with exactly known rays (Born & Wolf, Principles of Optics, 7th ed. 1999, section 4.2.2), and the
// profile of a boundary smoothed by a Gaussian. They are function objects for eikonal.h.

#include "optics/eikonal.h"

#include <cmath>
#include <numbers>

namespace pellucid {

/// Luneburg's lens: n = sqrt(2 - r^2) for r <= 1 (in radii of the ball around the origin), 1 outside. Parallel rays
/// focus where the ray through the centre leaves the ball.
template <class Real>
struct LuneburgField {
    Real radius = 1;
    IndexSample<Real> operator()(Vec3<Real> x) const {
        const Real squared = glm::dot(x, x) / (radius * radius);
        if (squared >= Real(1)) return {Vec3<Real>(0), Real(1)};
        const Real n = std::sqrt(Real(2) - squared);
        return {-x / (n * radius * radius), n};
    }
};

/// Maxwell's fish-eye: n = n0 / (1 + r^2), r in units of the radius. Rays are circles. Rays from a point on the sphere
/// of that radius meet again at the opposite point.
template <class Real>
struct MaxwellFisheyeField {
    Real radius = 1;
    Real n0 = 2;
    IndexSample<Real> operator()(Vec3<Real> x) const {
        const Real n = n0 / (Real(1) + glm::dot(x, x) / (radius * radius));
        return {-Real(2) * n * n / (n0 * radius * radius) * x, n};
    }
};

/// n = n0 + slope y. Rays that start horizontally are catenaries: y + n0 / slope = a cosh(x / a), see the tests.
template <class Real>
struct LinearField {
    Real n0 = 1;
    Real slope = Real(0.5);
    IndexSample<Real> operator()(Vec3<Real> x) const { return {Vec3<Real>(0, slope, 0), n0 + slope * x.y}; }
};

/// Share inside a plane boundary of a Gaussian of standard deviation `sigma`, centred `distance` away from the
/// boundary (positive: outside).
template <class Real>
Real smoothed_inside(Real distance, Real sigma) {
    return Real(0.5) * std::erfc(distance / (sigma * std::numbers::sqrt2_v<Real>));
}
/// Derivative of smoothed_inside() by the distance.
template <class Real>
Real smoothed_inside_slope(Real distance, Real sigma) {
    const Real t = distance / sigma;
    return -std::exp(-t * t / 2) / (sigma * std::sqrt(2 * std::numbers::pi_v<Real>));
}

/// Half-space y < 0 of index `inside`, with `outside` above it and a boundary smoothed by a Gaussian.
template <class Real>
struct SmoothedPlaneField {
    Real inside = Real(1.5);
    Real outside = 1;
    Real sigma = Real(0.01);
    IndexSample<Real> operator()(Vec3<Real> x) const {
        const Real step = inside - outside;
        return {Vec3<Real>(0, step * smoothed_inside_slope(x.y, sigma), 0),
                outside + step * smoothed_inside(x.y, sigma)};
    }
};

}  // namespace pellucid
