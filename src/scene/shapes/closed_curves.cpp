// Tubes along two closed curves: the torus knot and Bernoulli's lemniscate.

#include "scene/shapes/shape_builders.h"

#include <cmath>
#include <numbers>
#include <numeric>

namespace pellucid {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

struct CurvePoint {
    glm::dvec3 position;
    glm::dvec3 tangent;  ///< derivative, of any length
};

/// A tube along `curve(t)`, t in 0..2 pi.
template <class Curve>
Mesh make_curve_tube(const Curve& curve, const ShapeArguments& arguments) {
    const double tube = arguments.number("tube");
    // Test the exact curve, not its coarse approximation by this mesh.
    constexpr int kCheckCount = 1024;
    std::vector<glm::dvec3> fine;
    for (int i = 0; i < kCheckCount; ++i) fine.push_back(curve(kTwoPi * i / kCheckCount).position);
    if (!tube_is_clear(fine, tube)) arguments.fail("the tube would run into itself; use a smaller tube");

    const int segments = arguments.whole("segments");
    std::vector<glm::dvec3> centers, tangents;
    for (int i = 0; i < segments; ++i) {
        const CurvePoint point = curve(kTwoPi * i / segments);
        centers.push_back(point.position);
        tangents.push_back(glm::normalize(point.tangent));
    }
    return make_tube(transport_rings(centers, tangents), tube, arguments.whole("sides"));
}

}  // namespace

Mesh make_knot(const ShapeArguments& arguments) {
    const int p = arguments.whole("p"), q = arguments.whole("q");
    if (std::gcd(p, q) != 1) arguments.fail("p and q must not share a factor");
    const double tube = arguments.number("tube");
    // Radii of the torus that contains the knot. The knot's outermost point is 1 m from the axis.
    const double major = (1.0 - tube) / 1.42, minor = 0.42 * major;
    const auto knot = [=](double t) -> CurvePoint {
        const double cp = std::cos(p * t), sp = std::sin(p * t);
        const double cq = std::cos(q * t), sq = std::sin(q * t);
        const double from_axis = major + minor * cq, outward = -minor * q * sq;
        return {{from_axis * cp, from_axis * sp, minor * sq},
                {outward * cp - from_axis * p * sp, outward * sp + from_axis * p * cp, minor * q * cq}};
    };
    return make_curve_tube(knot, arguments);
}

Mesh make_infinity_ring(const ShapeArguments& arguments) {
    const double tube = arguments.number("tube");
    const double half_width = 1.0 - tube, lift = arguments.number("lift") * tube;
    const auto lemniscate = [=](double t) -> CurvePoint {
        const double c = std::cos(t), s = std::sin(t), d = 1.0 + s * s;
        return {{half_width * c / d, half_width * s * c / d, lift * s},
                {half_width * (-s * d - 2.0 * s * c * c) / (d * d),
                 half_width * ((c * c - s * s) * d - 2.0 * s * s * c * c) / (d * d), lift * c}};
    };
    return make_curve_tube(lemniscate, arguments);
}

}  // namespace pellucid
