#include "reference/ball_photons.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pellucid {
namespace {

struct Photon {
    glm::dvec3 x, d;
};

Photon through_ball(Photon photon, double radius, double ior) {
    for (const bool enters : {true, false}) {
        const double b = glm::dot(photon.x, photon.d), c = glm::dot(photon.x, photon.x) - radius * radius;
        const double root = enters ? b * b - c : b * b - std::min(c, 0.0);
        if (enters && root <= 0.0) return photon;
        photon.x += (-b + (enters ? -std::sqrt(root) : std::sqrt(root))) * photon.d;
        const glm::dvec3 normal = photon.x / radius * (enters ? 1.0 : -1.0);
        photon.d = glm::refract(photon.d, normal, enters ? 1.0 / ior : ior);
    }
    return photon;
}

bool meets_box(const Photon& photon, double half) {
    const glm::dvec3 a = (-half - photon.x) / photon.d, b = (half - photon.x) / photon.d;
    const glm::dvec3 low = glm::min(a, b), high = glm::max(a, b);
    return std::max({low.x, low.y, low.z}) < std::min({high.x, high.y, high.z});
}

}  // namespace

std::vector<double> count_photons(const BallAndPlane& scene, int photons) {
    std::vector<double> map(std::size_t(scene.width) * std::size_t(scene.height), 0.0);
    const glm::dvec3 d = scene.direction, normal = glm::cross(scene.side, scene.up);
    const glm::dvec3 side =
        glm::normalize(glm::cross(d, std::abs(d.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1)));
    const glm::dvec3 up = glm::cross(side, d);
    const double reach = 1.74 * scene.box, cell = 2.0 * reach / photons;  // the box from any side
    const double share = cell * cell / (scene.texel * scene.texel);
    for (int j = 0; j < photons; ++j)
        for (int i = 0; i < photons; ++i) {
            const glm::dvec3 start = (cell * (i + 0.5) - reach) * side + (cell * (j + 0.5) - reach) * up;
            Photon photon{start - 2.0 * reach * d, d};
            if (!meets_box(photon, scene.box)) continue;
            photon = through_ball(photon, scene.radius, scene.ior);
            const double t = glm::dot(scene.corner - photon.x, normal) / glm::dot(photon.d, normal);
            const glm::dvec3 at = photon.x + t * photon.d - scene.corner;
            const glm::dvec2 texel(std::floor(glm::dot(at, scene.side) / scene.texel),
                                   std::floor(glm::dot(at, scene.up) / scene.texel));
            if (!(t >= 0.0) || texel.x < 0.0 || texel.y < 0.0 || texel.x >= scene.width || texel.y >= scene.height)
                continue;
            map[std::size_t(texel.x) + std::size_t(scene.width) * std::size_t(texel.y)] += share;
        }
    return map;
}

CausticSpot caustic_spot(const std::vector<double>& map, int width, glm::dvec2 around, double reach) {
    CausticSpot spot;
    double sum = 0.0;
    std::vector<std::pair<double, double>> rings;  // distance from the centre, power
    const auto each = [&](auto&& use) {
        for (std::size_t i = 0; i < map.size(); ++i) {
            const glm::dvec2 at = glm::dvec2(i % std::size_t(width), i / std::size_t(width)) + 0.5;
            if (glm::distance(at, around) < reach) use(at, map[i]);
        }
    };
    each([&](glm::dvec2 at, double power) { spot.center += power * at, sum += power; });
    spot.center /= sum;
    each([&](glm::dvec2 at, double power) { rings.emplace_back(glm::distance(at, spot.center), power); });
    std::sort(rings.begin(), rings.end());
    double inside = 0.0;
    for (const auto& [distance, power] : rings) {
        if (inside >= 0.5 * sum) break;
        spot.radius = distance;
        inside += power;
    }
    return spot;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    double sum_a = 0.0, sum_b = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum_a += a[i], sum_b += b[i];
    const double mean_a = sum_a / double(a.size()), mean_b = sum_b / double(b.size());
    double aa = 0.0, bb = 0.0, ab = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double da = a[i] - mean_a, db = b[i] - mean_b;
        aa += da * da, bb += db * db, ab += da * db;
    }
    return ab / std::sqrt(std::max(aa * bb, 1e-300));
}

}  // namespace pellucid
