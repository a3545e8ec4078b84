// The ray equation in double precision against rays that are known: orders of the integrators, lenses, Snell's law.
#include "optics/eikonal.h"
#include "optics/index_fields.h"
#include "optics/phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace pellucid::test {
namespace {

using Real = double;
using Ray = CurvedRay<Real>;
using V = Vec3<Real>;

enum class Method { kEuler, kRk4, kLeapfrog, kNystrom };

template <RayStep kStep = RayStep::kSpace, class Field>
Ray advance(Method method, const Field& field, const Ray& ray, Real step) {
    switch (method) {
        case Method::kEuler:
            return euler_step<kStep>(field, ray, step);
        case Method::kRk4:
            return rk4_step<kStep>(field, ray, step);
        case Method::kLeapfrog:
            return leapfrog_step(field, ray, step);
        case Method::kNystrom:
            return nystrom_step(field, ray, step);
    }
    return ray;
}

/// Where the ray crosses the plane through the origin across `axis`, to the order of the method: the last step is made
/// shorter until it ends there.
template <class Field>
Ray follow_to_plane(Method method, const Field& field, Ray ray, V axis, Real step) {
    for (int guard = 0; guard < 10'000'000; ++guard) {
        const Ray next = advance(method, field, ray, step);
        if (glm::dot(next.x, axis) < 0.0) {
            ray = next;
            continue;
        }
        Real low = 0.0, high = step;
        for (int i = 0; i < 60; ++i) {
            const Real middle = 0.5 * (low + high);
            (glm::dot(advance(method, field, ray, middle).x, axis) < 0.0 ? low : high) = middle;
        }
        return advance(method, field, ray, high);
    }
    ADD_FAILURE() << "the ray never got there";
    return ray;
}

Real degrees_between(V a, V b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / std::numbers::pi;
}

/// Order of a method from the errors at the end of one ray with steps that are halved.
template <RayStep kStep, class Field>
std::vector<Real> measured_orders(Method method, const Field& field, const Ray& start, Real length, int first_steps) {
    const auto end = [&](int steps) {
        Ray ray = start;
        for (int i = 0; i < steps; ++i) ray = advance<kStep>(method, field, ray, length / steps);
        return ray;
    };
    Ray exact = start;  // by steps that are far shorter, of the better method
    for (int i = 0; i < 40'000; ++i) exact = rk4_step<kStep>(field, exact, length / 40'000);
    std::vector<Real> orders;
    for (int steps = first_steps; steps <= 4 * first_steps; steps *= 2)
        orders.push_back(std::log2(glm::distance(end(steps).x, exact.x) / glm::distance(end(2 * steps).x, exact.x)));
    return orders;
}

TEST(Eikonal, OrdersOfTheIntegrators) {
    const MaxwellFisheyeField<Real> field;
    const Ray start = start_ray<Real>(field, {-0.8, 0.2, 0.1}, glm::normalize(V(1.0, 0.4, -0.2)));
    for (const Real order : measured_orders<RayStep::kSpace>(Method::kEuler, field, start, 1.5, 800))
        EXPECT_NEAR(order, 1.0, 0.1);
    for (const Real order : measured_orders<RayStep::kSpace>(Method::kRk4, field, start, 1.5, 20))
        EXPECT_NEAR(order, 4.0, 0.3);
    for (const Real order : measured_orders<RayStep::kTime>(Method::kEuler, field, start, 2.0, 800))
        EXPECT_NEAR(order, 1.0, 0.1);
    for (const Real order : measured_orders<RayStep::kTime>(Method::kRk4, field, start, 2.0, 20))
        EXPECT_NEAR(order, 4.0, 0.3);
}

/// The same for methods whose steps are of sigma, ds = n dsigma: of these all are equal here.
template <class Field>
std::vector<Real> measured_sigma_orders(Method method, const Field& field, const Ray& start, Real sigma,
                                        int first_steps) {
    const auto end = [&](int steps) {
        Ray ray = start;
        for (int i = 0; i < steps; ++i) ray = advance(method, field, ray, sigma / steps * glm::length(ray.v));
        return ray;
    };
    const auto slope = [&](const Ray& ray) { return Ray{ray.v, field(ray.x).n * field(ray.x).gradient}; };
    Ray exact = start;
    const Real h = sigma / 40'000;
    for (int i = 0; i < 40'000; ++i) {  // Runge and Kutta's method on both first derivatives
        const Ray a = slope(exact), b = slope(advanced(exact, h / 2, a)), c = slope(advanced(exact, h / 2, b)),
                  d = slope(advanced(exact, h, c));
        exact = {exact.x + h / 6 * (a.x + 2.0 * b.x + 2.0 * c.x + d.x),
                 exact.v + h / 6 * (a.v + 2.0 * b.v + 2.0 * c.v + d.v)};
    }
    std::vector<Real> orders;
    for (int steps = first_steps; steps <= 4 * first_steps; steps *= 2)
        orders.push_back(std::log2(glm::distance(end(steps).x, exact.x) / glm::distance(end(2 * steps).x, exact.x)));
    return orders;
}

TEST(Eikonal, OrdersOfTheIntegratorsOfForces) {
    const MaxwellFisheyeField<Real> field;
    const Ray start = start_ray<Real>(field, {-0.8, 0.2, 0.1}, glm::normalize(V(1.0, 0.4, -0.2)));
    for (const Real order : measured_sigma_orders(Method::kLeapfrog, field, start, 1.0, 40))
        EXPECT_NEAR(order, 2.0, 0.1);
    for (const Real order : measured_sigma_orders(Method::kNystrom, field, start, 1.0, 20))
        EXPECT_NEAR(order, 4.0, 0.3);
}

// |v| should stay n. Steps of half a voxel of a ball of 60 voxels.
TEST(Eikonal, SpeedStaysTheIndex) {
    const MaxwellFisheyeField<Real> field;
    const auto drift = [&](Method method) {
        Ray ray = start_ray<Real>(field, {-0.8, 0.2, 0.1}, glm::normalize(V(1.0, 0.4, -0.2)));
        Real most = 0.0;
        for (int i = 0; i < 180; ++i) {
            ray = advance(method, field, ray, 0.5 / 60.0);
            most = std::max(most, std::abs(glm::length(ray.v) / field(ray.x).n - 1.0));
        }
        return most;
    };
    EXPECT_LT(drift(Method::kEuler), 2e-2);
    EXPECT_LT(drift(Method::kLeapfrog), 1e-4);
    EXPECT_LT(drift(Method::kRk4), 1e-8);
    EXPECT_LT(drift(Method::kNystrom), 1e-8);
    std::printf("drift of |v| / n: Euler %.1e, leapfrog %.1e, RK4 %.1e, Nystrom %.1e\n", drift(Method::kEuler),
                drift(Method::kLeapfrog), drift(Method::kRk4), drift(Method::kNystrom));
}

TEST(Eikonal, GradientsAreThoseOfTheIndex) {
    const V at(0.31, -0.24, 0.42);
    const auto check = [&](const auto& field, V x, const char* name) {
        constexpr Real kStep = 1e-6;
        for (int k = 0; k < 3; ++k) {
            V offset(0.0);
            offset[k] = kStep;
            const Real slope = (field(x + offset).n - field(x - offset).n) / (2.0 * kStep);
            EXPECT_NEAR(field(x).gradient[k], slope, 1e-6) << name << " " << k;
        }
    };
    check(LuneburgField<Real>{1.3}, at, "luneburg");
    check(MaxwellFisheyeField<Real>{0.9, 1.7}, at, "maxwell-fisheye");
    check(LinearField<Real>{1.2, 0.7}, at, "linear");
    check(SmoothedPlaneField<Real>{1.5, 1.0, 0.3}, at, "plane");
}

TEST(Eikonal, LuneburgFocusesParallelRaysAtTheAntipode) {
    const LuneburgField<Real> field;
    for (int i = -9; i <= 9; ++i) {
        const Real height = 0.1 * i;
        const Real in = std::sqrt(1.0 - height * height);
        Ray ray = start_ray<Real>(field, {-in, height, 0.0}, {1.0, 0.0, 0.0});
        ray.x.x += 1e-12;
        ray.v = field(ray.x).n * V(1.0, 0.0, 0.0);
        // The ray ends on the plane that touches the ball there: on the axis.
        const auto shifted = [&](V x) { return field(x + V(1.0, 0.0, 0.0)); };
        ray.x.x -= 1.0;
        const Ray end = follow_to_plane(Method::kRk4, shifted, ray, {1.0, 0.0, 0.0}, 0.001);
        EXPECT_NEAR(end.x.y, 0.0, 2e-4) << height;
    }
}

TEST(Eikonal, MaxwellFisheyeImagesThePointOppositeOnTheSphere) {
    const MaxwellFisheyeField<Real> field;
    for (const Real angle : {-80.0, -45.0, -10.0, 20.0, 60.0}) {
        const Real a = angle * std::numbers::pi / 180.0;
        // From (-1, 0, 0) inwards; all rays pass (1, 0, 0).
        const Ray start = start_ray<Real>(field, {-1.0, 0.0, 0.0}, {std::cos(a), std::sin(a), 0.0});
        const auto shifted = [&](V x) { return field(x + V(1.0, 0.0, 0.0)); };
        Ray ray = start;
        ray.x.x -= 1.0;
        const Ray end = follow_to_plane(Method::kRk4, shifted, ray, {1.0, 0.0, 0.0}, 0.005);
        EXPECT_NEAR(end.x.y, 0.0, 1e-7) << angle;
    }
}

TEST(Eikonal, LinearIndexBendsRaysIntoCatenaries) {
    const LinearField<Real> field{1.0, 0.5};
    // Level at height 0: n(y) = cosh(slope x / n0) n0 along the ray.
    const Ray start = start_ray<Real>(field, {-1.5, 0.0, 0.0}, {1.0, 0.0, 0.0});
    const Ray end = follow_to_plane(Method::kRk4, field, start, {1.0, 0.0, 0.0}, 0.01);
    EXPECT_NEAR(end.x.y, (std::cosh(0.5 * 1.5) - 1.0) / 0.5, 1e-9);
    EXPECT_NEAR(glm::length(end.v), field(end.x).n, 1e-9);
}

/// The direction in which a ray at `angle_deg` to the normal leaves a smoothed plane; from below (inside) or above.
V crossed_plane(Real angle_deg, bool from_inside) {
    const SmoothedPlaneField<Real> field{1.5, 1.0, 0.75};  // voxels
    const Real a = angle_deg * std::numbers::pi / 180.0, side = from_inside ? -1.0 : 1.0;
    Ray ray = start_ray<Real>(field, {0.0, 8.0 * side, 0.0}, {std::sin(a), -side * std::cos(a), 0.0});
    while (std::abs(ray.x.y) <= 8.5) ray = rk4_step(field, ray, 0.25);
    return glm::normalize(ray.v);
}

TEST(Eikonal, SmoothedPlaneObeysSnellAndReflectsTotallyBeyondTheCriticalAngle) {
    for (int degrees = 0; degrees <= 85; degrees += 5) {
        V exact;
        const Real a = degrees * std::numbers::pi / 180.0;
        ASSERT_TRUE(refract_direction<Real>({std::sin(a), -std::cos(a), 0.0}, {0.0, 1.0, 0.0}, 1.0 / 1.5, exact));
        EXPECT_LT(degrees_between(crossed_plane(degrees, false), exact), 0.05) << degrees;
    }
    const Real critical = std::asin(1.0 / 1.5) * 180.0 / std::numbers::pi;
    EXPECT_GT(crossed_plane(critical - 0.1, true).y, 0.0);  // goes through
    EXPECT_LT(crossed_plane(critical + 0.1, true).y, 0.0);  // is reflected
    const V reflected = crossed_plane(60.0, true);
    const Real a = 60.0 * std::numbers::pi / 180.0;
    EXPECT_LT(degrees_between(reflected, {std::sin(a), -std::cos(a), 0.0}), 0.05);
}

TEST(Phase, HenyeyGreensteinHasItsIntegralAndItsMean) {
    for (const double g : {-0.7, 0.0, 0.4, 0.9}) {
        double whole = 0.0, mean = 0.0;
        constexpr int kSteps = 200'000;
        for (int i = 0; i < kSteps; ++i) {
            const double c = -1.0 + 2.0 * (i + 0.5) / kSteps,
                         share = henyey_greenstein(c, g) * 4.0 * std::numbers::pi / kSteps;
            whole += share;
            mean += c * share;
        }
        EXPECT_NEAR(whole, 1.0, 1e-6) << g;
        EXPECT_NEAR(mean, g, 1e-6) << g;
    }
}

}  // namespace
}  // namespace pellucid::test
