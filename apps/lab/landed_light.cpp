#include "lab/landed_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid {

void set_level_map(BallAndPlane& plane, double half_edge, double height, double texel) {
    plane.width = plane.height = int(std::ceil(2.0 * half_edge / texel - 1e-3));
    plane.texel = 2.0 * half_edge / plane.width;
    plane.corner = {-half_edge, height, half_edge};
    plane.side = {1.0, 0.0, 0.0};
    plane.up = {0.0, 0.0, -1.0};
}

std::vector<double> landed_map(std::span<const LandedPhoton> photons, const BallAndPlane& plane, int color) {
    constexpr double kFewest = 48.0, kMost = 1024.0, kGoldenAngle = 2.399963229728653;
    std::vector<double> map(std::size_t(plane.width) * std::size_t(plane.height), 0.0);
    for (const LandedPhoton& photon : photons) {
        const glm::dvec3 from_corner = photon.position - plane.corner;
        const glm::dvec2 center(glm::dot(from_corner, plane.side), glm::dot(from_corner, plane.up));
        const double texels = std::numbers::pi * photon.radius * photon.radius / (plane.texel * plane.texel);
        const int count = int(std::clamp(texels, kFewest, kMost));
        const double share = photon.flux[color] / (count * plane.texel * plane.texel);
        for (int i = 0; i < count; ++i) {
            // Points of equal power in the kernel of light/photon_lookup.glsl: its power within squared relative
            // radius s is 1 - (1 - s)^3.
            const double radius = photon.radius * std::sqrt(1.0 - std::cbrt(1.0 - (i + 0.5) / count));
            const glm::dvec2 point(std::cos(i * kGoldenAngle), std::sin(i * kGoldenAngle));
            const glm::dvec2 at = glm::floor((center + radius * point) / plane.texel);
            if (at.x < 0.0 || at.y < 0.0 || at.x >= plane.width || at.y >= plane.height) continue;
            map[std::size_t(at.x) + std::size_t(plane.width) * std::size_t(at.y)] += share;
        }
    }
    return map;
}

}  // namespace pellucid
