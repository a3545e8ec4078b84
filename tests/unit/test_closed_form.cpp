// The closed-form tracer against answers worked out by hand.
#include "closed_form/closed_form_scene.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace pellucid::closed_form {
namespace {

constexpr int kMost = 16;

Shell ball(glm::dvec3 center, double radius, int winding = 1) {
    return {ShellKind::kBall, glm::scale(glm::translate(glm::dmat4(1), center), glm::dvec3(radius)), winding};
}
Shell box(glm::dvec3 center, glm::dvec3 half) {
    return {ShellKind::kBox, glm::scale(glm::translate(glm::dmat4(1), center), half), 1};
}
Body body(std::vector<Shell> shells, double ior, glm::dvec3 sigma_a = glm::dvec3(0.0), int priority = 0) {
    const double volume = material_volume(shells);
    return {std::move(shells), {ior, sigma_a}, priority, volume};
}
/// A ray along -Z that meets (x, y, 0).
Ray down(double x, double y = 0.0) { return {{x, y, 10.0}, {0, 0, -1}}; }

/// Bodies in their order, as letters; reflections as capitals.
std::string order(const Path& path) {
    const auto letter = [](int b) { return b == kOutside ? '.' : char('a' + b); };
    std::string text;
    if (!path.events.empty()) text += letter(path.events.front().before);
    for (const Event& e : path.events) text += e.total ? char('A' + e.before) : letter(e.after);
    return text;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-12) {
    EXPECT_LE(glm::length(a - b), tolerance)
        << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

TEST(ClosedForm, SlabStraightOn) {
    const Scene scene({body({box({0, 0, 0}, {1, 1, 1})}, 1.5, {0.5, 0.25, 0.0})});
    const Path path = scene.trace(down(0.3, 0.2), kMost);
    EXPECT_EQ(order(path), ".a.");
    expect_near(path.direction, {0, 0, -1});
    expect_near(path.transmittance, {0.9216 * std::exp(-1.0), 0.9216 * std::exp(-0.5), 0.9216});
    EXPECT_DOUBLE_EQ(path.length, 11.0);
    EXPECT_DOUBLE_EQ(path.length_inside, 2.0);
    expect_near(path.events[1].position, {0.3, 0.2, -1.0});
}

TEST(ClosedForm, SlabShiftsAnObliqueRay) {
    const Scene scene({body({box({0, 0, 0}, {10, 10, 0.5})}, 1.5)});
    const double theta = 0.6, sin_t = std::sin(theta) / 1.5;
    const glm::dvec3 d(std::sin(theta), 0.0, -std::cos(theta));
    const Path path = scene.trace({glm::dvec3(0, 0, 0.5) - 2.0 * d, d}, kMost);
    EXPECT_EQ(order(path), ".a.");
    expect_near(path.direction, d);
    expect_near(path.events[1].position, {sin_t / std::sqrt(1.0 - sin_t * sin_t), 0.0, -0.5});
}

TEST(ClosedForm, TurnedSlabIsTheTurnedAnswer) {
    const glm::dmat4 turn = glm::rotate(glm::translate(glm::dmat4(1), {3, 1, -2}), 1.1, glm::dvec3(0.6, 0.0, 0.8));
    Body slab = body({box({0, 0, 0}, {10, 10, 0.5})}, 1.5);
    slab.shells[0].world_from_shell = turn * slab.shells[0].world_from_shell;
    const glm::dvec3 d = glm::normalize(glm::dvec3(0.4, 0.1, -1.0));
    const glm::dvec3 origin(turn * glm::dvec4(0, 0, 3, 1)), direction = glm::dmat3(turn) * d;
    const Path path = Scene({slab}).trace({origin, direction}, kMost);
    EXPECT_EQ(order(path), ".a.");
    expect_near(path.direction, direction);
}

TEST(ClosedForm, BallDeflectsByTwiceTheDifferenceOfAngles) {
    const Scene scene({body({ball({0, 0, 0}, 2.0)}, 1.5)});
    for (const double sin_i : {0.0, 0.2, 0.7, 0.95}) {
        const Path path = scene.trace(down(2.0 * sin_i), kMost);
        const double turned = 2.0 * (std::asin(sin_i) - std::asin(sin_i / 1.5));
        EXPECT_EQ(order(path), ".a.");
        expect_near(path.direction, {-std::sin(turned), 0.0, -std::cos(turned)});
        EXPECT_NEAR(path.length_inside, 4.0 * std::sqrt(1.0 - sin_i * sin_i / 2.25), 1e-12);
    }
    EXPECT_EQ(order(scene.trace(down(2.001), kMost)), "");
}

TEST(ClosedForm, EllipsoidRefractsByItsOwnNormal) {
    Body egg = body({ball({0, 0, 0}, 1.0)}, 1.5);
    egg.shells[0].world_from_shell = glm::scale(glm::dmat4(1), glm::dvec3(2.0, 1.0, 1.0));
    const Path path = Scene({egg}).trace(down(1.0), 1);
    // The point (1, 0, sqrt(3)/2) of x^2/4 + z^2 = 1; its normal is along (x/4, 0, z).
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.25, 0.0, std::sqrt(0.75)));
    const double sin_i = n.x, sin_t = sin_i / 1.5;
    const glm::dvec3 along(n.z, 0.0, -n.x);
    expect_near(path.events[0].position, {1.0, 0.0, std::sqrt(0.75)});
    expect_near(path.direction, -std::sqrt(1.0 - sin_t * sin_t) * n + sin_t * along);
}

TEST(ClosedForm, ConcentricShellsKeepTheImpactParameter) {
    // n r sin(theta) is the same at every surface of spheres around one point (Bouguer).
    const double sigma_outer = 0.3, sigma_inner = 0.7;
    const Scene scene({body({ball({0, 0, 0}, 1.0)}, 1.5, glm::dvec3(sigma_outer)),
                       body({ball({0, 0, 0}, 0.5)}, 1.2, glm::dvec3(sigma_inner))});
    const double b = 0.4;
    const Path path = scene.trace(down(b), kMost);
    EXPECT_EQ(order(path), ".aba.");
    const double a1 = std::asin(b), a2 = std::asin(b / 1.5), a3 = std::asin(b / (1.5 * 0.5)),
                 a4 = std::asin(b / (1.2 * 0.5));
    const double turned = 2.0 * ((a1 - a2) + (a3 - a4));
    expect_near(path.direction, {-std::sin(turned), 0.0, -std::cos(turned)});
    const double inner = std::cos(a4), outer = 2.0 * (std::cos(a2) - 0.5 * std::cos(a3));
    EXPECT_NEAR(path.length_inside, inner + outer, 1e-12);
    const auto transmitted = [](double theta_i, double theta_t) {
        const double s = std::sin(theta_i - theta_t) / std::sin(theta_i + theta_t);
        const double p = std::tan(theta_i - theta_t) / std::tan(theta_i + theta_t);
        return 1.0 - 0.5 * (s * s + p * p);
    };
    const double t = transmitted(a1, a2) * transmitted(a3, a4);
    EXPECT_NEAR(path.transmittance.r, t * t * std::exp(-sigma_outer * outer - sigma_inner * inner), 1e-12);
}

TEST(ClosedForm, EyeInABallOfWater) {
    const Scene scene({body({ball({0, 0, 0}, 1.0)}, 4.0 / 3.0, {0.2, 0.1, 0.0})});
    // From a point at 0.5 at right angles to the radius: sin(theta_i) is 0.5 at the surface.
    const Path path = scene.trace({{0.5, 0, 0}, {0, 0, -1}}, kMost);
    EXPECT_EQ(order(path), "a.");
    const double turned = std::asin(0.5 * 4.0 / 3.0) - std::asin(0.5);
    expect_near(path.direction, {-std::sin(turned), 0.0, -std::cos(turned)});
    EXPECT_NEAR(path.length, std::sqrt(0.75), 1e-12);
    EXPECT_NEAR(path.transmittance.r / path.transmittance.b, std::exp(-0.2 * std::sqrt(0.75)), 1e-12);
    // Beyond R / n no light gets out.
    const Path trapped = scene.trace({{0.76, 0, 0}, {0, 0, -1}}, kMost);
    EXPECT_EQ(order(trapped), "a" + std::string(16, 'A'));
    EXPECT_TRUE(trapped.cut);
    EXPECT_EQ(trapped.reflections(), 16);
}

TEST(ClosedForm, SideOfACubeReflectsTotally) {
    const Scene scene({body({box({0, 0, 0}, {1, 1, 1})}, 1.5)});
    const glm::dvec3 d(std::sqrt(0.75), 0.0, -0.5);
    const Path path = scene.trace({glm::dvec3(0.9, 0, 1) - d, d}, kMost);
    EXPECT_EQ(order(path), ".aA.");
    expect_near(path.direction, {-d.x, 0.0, d.z});
    const double sin_t = d.x / 1.5;
    EXPECT_NEAR(path.length_inside, 2.0 / std::sqrt(1.0 - sin_t * sin_t), 1e-12);
}

TEST(ClosedForm, BodiesDisplaceEachOther) {
    const std::vector<Shell> large{box({0, 0, 0}, {1, 1, 1})}, small{box({0, 0, 0}, {0.5, 0.5, 0.5})};
    EXPECT_EQ(order(Scene({body(small, 1.7), body(large, 1.5)}).trace(down(0.1), kMost)), ".bab.");
    EXPECT_EQ(order(Scene({body(small, 1.7), body(large, 1.5, {}, 1)}).trace(down(0.1), kMost)), ".b.");
    EXPECT_EQ(order(Scene({body(small, 1.7, {}, -1), body(large, 1.5)}).trace(down(0.1), kMost)), ".b.");
    // Equal volumes: the later in the order.
    const std::vector<Shell> left{box({0, 0, 0.25}, {1, 1, 0.5})}, right{box({0, 0, -0.25}, {1, 1, 0.5})};
    EXPECT_EQ(order(Scene({body(left, 1.7), body(right, 1.5)}).trace(down(0.1), kMost)), ".ab.");
    EXPECT_NEAR(Scene({body(left, 1.7), body(right, 1.5)}).trace(down(0.1), kMost).events[1].position.z, 0.25, 1e-12);
    EXPECT_NEAR(Scene({body(right, 1.7), body(left, 1.5)}).trace(down(0.1), kMost).events[1].position.z, -0.25, 1e-12);
}

TEST(ClosedForm, SurfacesInContactAreOne) {
    const std::vector<Shell> front{box({0, 0, 1}, {1, 1, 1})}, back{box({0, 0, -1}, {2, 2, 1})};
    EXPECT_EQ(order(Scene({body(front, 1.5), body(back, 1.7)}).trace(down(0.1), kMost)), ".ab.");
    EXPECT_EQ(order(Scene({body(front, 1.5), body(back, 1.5)}).trace(down(0.1), kMost)), ".a.");
    EXPECT_EQ(order(Scene({body({front[0], back[0]}, 1.5)}).trace(down(0.1), kMost)), ".a.");
    EXPECT_EQ(order(Scene({body(front, 1.5), body(front, 1.7)}).trace(down(0.1), kMost)), ".b.");
    const double extent = 4.0, touching = 0.9e-6 * extent, apart = 1.1e-6 * extent;
    const auto with_gap = [&](double gap) {
        return Scene({body(front, 1.5), body({box({0, 0, -1 - gap}, {2, 2, 1})}, 1.7)});
    };
    EXPECT_EQ(order(with_gap(touching).trace(down(0.1), kMost)), ".ab.");
    EXPECT_EQ(order(with_gap(apart).trace(down(0.1), kMost)), ".a.b.");
    // Measured across the gap, not along the ray.
    const glm::dvec3 d = glm::normalize(glm::dvec3(1.2, 0, -1.0));
    EXPECT_EQ(order(with_gap(touching).trace({glm::dvec3(-0.8, 0, 2) - d, d}, 2)), ".ab");
}

TEST(ClosedForm, OneBodyIsTheUnionOfItsShells) {
    const Scene two({body({ball({0, 0, 0.5}, 1.0), ball({0, 0, -0.5}, 1.0)}, 1.5)});
    const Path path = two.trace(down(0.0), kMost);
    EXPECT_EQ(order(path), ".a.");
    EXPECT_NEAR(path.length_inside, 3.0, 1e-12);
    EXPECT_EQ(order(Scene({body({ball({0, 0, 0}, 1.0), ball({0, 0, 0}, 1.0)}, 1.5)}).trace(down(0.2), kMost)), ".a.");
    EXPECT_EQ(order(Scene({body({ball({0, 0, 0}, 1.0), ball({0, 0, 0}, 0.5)}, 1.5)}).trace(down(0.2), kMost)), ".a.");
    const Scene hollow({body({ball({0, 0, 0}, 1.0), ball({0, 0, 0}, 0.5, -1)}, 1.5)});
    EXPECT_EQ(order(hollow.trace(down(0.1), kMost)), ".a.a.");
    EXPECT_EQ(hollow.body_at({0, 0, 0}), kOutside);
    EXPECT_EQ(hollow.body_at({0, 0, 0.7}), 0);
    // Liquid whose surface is the wall of the hollow.
    const Scene filled(
        {body({ball({0, 0, 0}, 1.0), ball({0, 0, 0}, 0.5, -1)}, 1.5), body({ball({0, 0, 0}, 0.5)}, 1.3)});
    EXPECT_EQ(order(filled.trace(down(0.1), kMost)), ".aba.");
}

TEST(ClosedForm, VolumesOfUnions) {
    const double pi = 3.14159265358979;
    EXPECT_NEAR(material_volume({ball({1, 2, 3}, 0.5)}), pi / 6.0, 1e-12);
    EXPECT_NEAR(material_volume({box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {1, 1, 1})}), 12.0, 0.01);
    // Two balls of radius 1 whose centres are 1 apart share a lens of 5 pi / 12.
    EXPECT_NEAR(material_volume({ball({0, 0, 0}, 1.0), ball({1, 0, 0}, 1.0)}), (8.0 / 3.0 - 5.0 / 12.0) * pi, 0.01);
    EXPECT_NEAR(material_volume({ball({0, 0, 0}, 1.0), ball({0, 0, 0}, 0.5, -1)}), 4.0 / 3.0 * pi * 0.875, 0.01);
}

TEST(ClosedForm, ViewRays) {
    View view;
    view.world_from_view = glm::translate(glm::dmat4(1), {1, 2, 3});
    view.vertical_fov = 1.5707963267948966;
    expect_near(view.ray({32, 32}, 64).direction, {0, 0, -1});
    expect_near(view.ray({64, 0}, 64).direction, glm::normalize(glm::dvec3(1, 1, -1)));
    view.orthographic = true;
    view.vertical_extent = 4.0;
    expect_near(view.ray({64, 0}, 64).origin, {3, 4, 3});
    expect_near(view.ray({64, 0}, 64).direction, {0, 0, -1});
}

}  // namespace
}  // namespace pellucid::closed_form
