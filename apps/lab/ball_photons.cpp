#include "lab/ball_photons.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace pellucid {
namespace {

struct Photon {
    glm::dvec3 x, d;
};

/// Traces a photon to its exit from the ball. Returns false if it misses the ball.
bool through_sharp_ball(Photon& photon, double radius, double ior) {
    for (const bool enters : {true, false}) {
        const double b = glm::dot(photon.x, photon.d), c = glm::dot(photon.x, photon.x) - radius * radius;
        const double root = enters ? b * b - c : b * b - std::min(c, 0.0);
        if (enters && root <= 0.0) return false;
        photon.x += (-b + (enters ? -std::sqrt(root) : std::sqrt(root))) * photon.d;
        const glm::dvec3 normal = photon.x / radius * (enters ? 1.0 : -1.0);
        photon.d = glm::refract(photon.d, normal, enters ? 1.0 / ior : ior);
    }
    return true;
}

/// Traces a photon through a ball whose index is smoothed across its surface: straight in uniform regions, by Runge
/// and Kutta's method elsewhere. Ihrke et al. 2007, equations 9 and 10. Returns false if it misses the ball.
bool through_smoothed_ball(Photon& photon, const BallAndPlane& scene) {
    const double sigma = scene.smoothing, outer = scene.radius + 5.0 * sigma, inner = scene.radius - 5.0 * sigma;
    const double b = glm::dot(photon.x, photon.d), root = b * b - glm::dot(photon.x, photon.x) + outer * outer;
    if (root <= 0.0) return false;
    const auto index = [&](double r) {
        return 1.0 + 0.5 * (scene.ior - 1.0) * std::erfc((r - scene.radius) / (std::numbers::sqrt2 * sigma));
    };
    const auto gradient = [&](const glm::dvec3& x) {
        const double r = glm::length(x), off = (r - scene.radius) / sigma;
        return -(scene.ior - 1.0) / (sigma * std::sqrt(2.0 * std::numbers::pi)) * std::exp(-0.5 * off * off) / r * x;
    };
    const auto way = [&](const Photon& at) { return at.d / index(glm::length(at.x)); };
    photon.x += (-b - std::sqrt(root)) * photon.d;
    const double h = 0.05 * sigma;
    for (bool inside = false; !inside || glm::length(photon.x) < outer;) {
        if (glm::length(photon.x) < inner) {
            const glm::dvec3 d = glm::normalize(photon.d);
            const double along = glm::dot(photon.x, d);
            photon.x += (-along + std::sqrt(along * along - glm::dot(photon.x, photon.x) + inner * inner)) * d;
        }
        const auto moved = [&](const Photon& by, double t) { return Photon{photon.x + t * by.x, photon.d + t * by.d}; };
        const Photon k1{way(photon), gradient(photon.x)};
        const Photon a2 = moved(k1, 0.5 * h), k2{way(a2), gradient(a2.x)};
        const Photon a3 = moved(k2, 0.5 * h), k3{way(a3), gradient(a3.x)};
        const Photon a4 = moved(k3, h), k4{way(a4), gradient(a4.x)};
        photon.x += h / 6.0 * (k1.x + 2.0 * k2.x + 2.0 * k3.x + k4.x);
        photon.d += h / 6.0 * (k1.d + 2.0 * k2.d + 2.0 * k3.d + k4.d);
        inside = inside || glm::length(photon.x) < outer;
    }
    photon.d = glm::normalize(photon.d);
    return true;
}

bool meets_box(const Photon& photon, double half) {
    const glm::dvec3 a = (-half - photon.x) / photon.d, b = (half - photon.x) / photon.d;
    const glm::dvec3 low = glm::min(a, b), high = glm::max(a, b);
    return std::max({low.x, low.y, low.z}) < std::min({high.x, high.y, high.z});
}

/// Adds the lengths of a ray from photon.x in the voxels of a cube around the origin.
void add_lengths(VoxelPhotons& voxels, double half, const Photon& photon, double weight) {
    const int n = voxels.resolution;
    const double edge = 2.0 * half / n;
    const glm::dvec3 start = (photon.x + half) / edge;
    // Step from face to face, in the order in which the ray crosses them.
    const glm::dvec3 a = -start / photon.d, b = (double(n) - start) / photon.d;
    const glm::dvec3 low = glm::min(a, b), high = glm::max(a, b);
    double t = std::max({0.0, low.x, low.y, low.z});
    const double end = std::min({high.x, high.y, high.z});
    if (!(t < end)) return;
    const glm::dvec3 at = start + (t + 1e-9) * photon.d;
    glm::ivec3 voxel = glm::clamp(glm::ivec3(glm::floor(at)), 0, n - 1);
    glm::dvec3 next;
    for (int k = 0; k < 3; ++k) next[k] = (voxel[k] + (photon.d[k] > 0.0 ? 1 : 0) - start[k]) / photon.d[k];
    while (t < end) {
        const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : next.y < next.z ? 1 : 2;
        const double until = std::min(next[axis], end);
        const std::size_t i =
            std::size_t(voxel.x) + std::size_t(n) * (std::size_t(voxel.y) + std::size_t(n) * std::size_t(voxel.z));
        voxels.fluence[i] += weight * (until - t);
        voxels.photons[i] += 1.0;
        t = until;
        voxel[axis] += photon.d[axis] > 0.0 ? 1 : -1;
        if (voxel[axis] < 0 || voxel[axis] >= n) return;
        next[axis] += 1.0 / std::abs(photon.d[axis]);
    }
}

/// Calls `use(photon, area)` for photons on `rings` rings around the axis, after the ball. All photons of a ring take
/// the same path up to rotation.
template <class Use>
void for_each_photon(const BallAndPlane& scene, int rings, const Use& use) {
    const glm::dvec3 d = scene.direction;
    const glm::dvec3 side =
        glm::normalize(glm::cross(d, std::abs(d.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1)));
    const glm::dvec3 up = glm::cross(side, d);
    const double reach = 1.74 * scene.box, width = reach / rings;  // covers the box from any side
    constexpr double kGoldenAngle = 2.399963;
    for (int ring = 0; ring < rings; ++ring) {
        const double off = (ring + 0.5) * width;
        Photon along{off * side - 2.0 * reach * d, d};
        const bool bent = scene.smoothing > 0.0 ? through_smoothed_ball(along, scene)
                                                : through_sharp_ball(along, scene.radius, scene.ior);
        const int count = std::max(6, int(std::lround(2.0 * std::numbers::pi * (ring + 0.5))));
        const double area = 2.0 * std::numbers::pi * off * width / count;
        for (int k = 0; k < count; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / count + kGoldenAngle * ring;
            const glm::dvec3 outward = std::cos(angle) * side + std::sin(angle) * up;
            if (!meets_box({off * outward - 2.0 * reach * d, d}, scene.box)) continue;
            const auto turned = [&](const glm::dvec3& v) { return glm::dot(v, side) * outward + glm::dot(v, d) * d; };
            use(bent ? Photon{turned(along.x), turned(along.d)} : Photon{off * outward - 2.0 * reach * d, d}, area);
        }
    }
}

}  // namespace

VoxelPhotons count_voxel_photons(const BallAndPlane& scene, int resolution, int per_voxel) {
    const std::size_t count = std::size_t(resolution) * std::size_t(resolution) * std::size_t(resolution);
    VoxelPhotons voxels{resolution, std::vector<double>(count, 0.0), std::vector<double>(count, 0.0)};
    const double edge = 2.0 * scene.box / resolution;
    for_each_photon(scene, int(1.74 * 0.5 * resolution * per_voxel), [&](const Photon& photon, double area) {
        add_lengths(voxels, scene.box, photon, area / (edge * edge));
    });
    return voxels;
}

std::vector<double> count_photons(const BallAndPlane& scene, int photons) {
    std::vector<double> map(std::size_t(scene.width) * std::size_t(scene.height), 0.0);
    const glm::dvec3 normal = glm::cross(scene.side, scene.up);
    for_each_photon(scene, photons, [&](const Photon& photon, double area) {
        const double t = glm::dot(scene.corner - photon.x, normal) / glm::dot(photon.d, normal);
        const glm::dvec3 at = photon.x + t * photon.d - scene.corner;
        const glm::dvec2 texel(std::floor(glm::dot(at, scene.side) / scene.texel),
                               std::floor(glm::dot(at, scene.up) / scene.texel));
        if (!(t >= 0.0) || texel.x < 0.0 || texel.y < 0.0 || texel.x >= scene.width || texel.y >= scene.height) return;
        map[std::size_t(texel.x) + std::size_t(scene.width) * std::size_t(texel.y)] +=
            area / (scene.texel * scene.texel);
    });
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
