// The first wavefronts of lights (Ihrke et al. 2007, section 4.2). A front is a plane, or a part of a sphere as seen
// through the face of a cube.
#include "volume/light_fronts.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace pellucid {
namespace {

struct Basis {
    glm::dvec3 side, up, forward;  // right-handed
};

Basis basis_around(glm::dvec3 forward) {
    const glm::dvec3 other = std::abs(forward.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 side = glm::normalize(glm::cross(other, forward));
    return {side, glm::cross(forward, side), forward};
}

std::array<glm::dvec3, 8> corners_of(const VolumeRecord& volume) {
    std::array<glm::dvec3, 8> corners;
    for (unsigned k = 0; k < 8; ++k) {
        const glm::dvec3 at = glm::dvec3(volume.size) * glm::dvec3(k & 1, k >> 1 & 1, k >> 2);
        corners[k] = glm::dvec3(glm::dmat4(volume.world_from_voxel) * glm::dvec4(at, 1.0));
    }
    return corners;
}

double brightest(glm::vec3 color) { return double(std::max({color.r, color.g, color.b})); }

/// A front without a patch count.
struct Draft {
    const Light* light;
    std::uint32_t volume;
    glm::dvec3 corner, side, up;  // of the whole front
    double width, height;         // lengths of side and up
    double cell;                  // wanted side of a patch, in the same unit
    double start = 0.0;           // distance from a point light at which patches begin, m
};

double floats(double x) { return std::max(1.0, std::ceil(x)); }

std::vector<Draft> drafts_of(const Light& light, std::span<const VolumeRecord> volumes, double side) {
    std::vector<Draft> drafts;
    double first = std::numeric_limits<double>::max();
    const glm::dvec3 direction(light.direction);
    for (const VolumeRecord& volume : volumes)
        for (const glm::dvec3 corner : corners_of(volume)) first = std::min(first, glm::dot(corner, direction));
    for (std::uint32_t i = 0; i < volumes.size(); ++i) {
        const VolumeRecord& volume = volumes[i];
        const double voxel = double(volume.voxel), cell = side * voxel;
        const std::array corners = corners_of(volume);
        if (light.kind == Light::Kind::kDirectional) {
            const Basis basis = basis_around(direction);
            glm::dvec2 low(std::numeric_limits<double>::max()), high(-std::numeric_limits<double>::max());
            for (const glm::dvec3 corner : corners) {
                const glm::dvec2 at(glm::dot(corner, basis.side), glm::dot(corner, basis.up));
                low = glm::min(low, at);
                high = glm::max(high, at);
            }
            const glm::dvec2 extent = high - low;
            drafts.push_back({&light, i, low.x * basis.side + low.y * basis.up + (first - voxel) * direction,
                              extent.x * basis.side, extent.y * basis.up, extent.x, extent.y, cell});
            continue;
        }
        const glm::dvec3 origin(light.position);
        glm::dvec3 middle(0.0);
        for (const glm::dvec3 corner : corners) middle += 0.125 * corner;
        const double radius = glm::distance(middle, corners[0]), distance = glm::distance(middle, origin);
        const glm::dvec3 at = glm::dvec3(glm::dmat4(volume.voxel_from_world) * glm::dvec4(origin, 1.0));
        const glm::dvec3 beside = glm::max(glm::max(-at, at - glm::dvec3(volume.size)), 0.0);
        const bool inside = glm::length(beside) < 1.0;
        // A light inside the box emits patches that are small at first and are split as they grow.
        const double angle = inside ? 2.0 / 48.0 : cell / std::max(distance, radius),
                     start = inside ? 0.5 * voxel : 0.0;
        const auto face = [&](const Basis& b, double reach) {
            drafts.push_back({&light, i, b.forward - reach * (b.side + b.up), 2.0 * reach * b.side, 2.0 * reach * b.up,
                              2.0 * reach, 2.0 * reach, angle, start});
        };
        if (distance > 1.4 * radius) {
            face(basis_around((middle - origin) / distance),
                 1.02 * radius / std::sqrt(distance * distance - radius * radius));
            continue;
        }
        for (int axis = 0; axis < 3; ++axis)
            for (const double sign : {1.0, -1.0}) {
                glm::dvec3 forward(0.0);
                forward[axis] = sign;
                face(basis_around(forward), 1.0);
            }
    }
    return drafts;
}

}  // namespace

LightFronts make_fronts(std::span<const Light> lights, std::span<const VolumeRecord> volumes,
                        const FrontOptions& options) {
    std::vector<Draft> drafts;
    LightFronts result;
    for (const Light& light : lights) {
        if (!(brightest(light.intensity) > 0.0)) continue;
        const std::vector<Draft> own = drafts_of(light, volumes, double(options.side));
        drafts.insert(drafts.end(), own.begin(), own.end());
        double area = 4.0 * std::numbers::pi;
        if (light.kind == Light::Kind::kDirectional) {
            area = 0.0;
            for (const Draft& draft : own) area += draft.width * draft.height;
        }
        result.most_power += brightest(light.intensity) * area;
    }
    double scale = 1.0;
    const auto total = [&] {
        double sum = 0.0;
        for (const Draft& d : drafts) sum += floats(d.width / (scale * d.cell)) * floats(d.height / (scale * d.cell));
        return sum;
    };
    const double colors = options.per_color ? 3.0 : 1.0;
    while (colors * total() > double(options.most_patches) && scale < 1e6) scale *= 1.1, result.coarsened = true;
    for (const Draft& draft : drafts) {
        const Light& light = *draft.light;
        const double across = floats(draft.width / (scale * draft.cell)),
                     along = floats(draft.height / (scale * draft.cell));
        const double share = draft.width / across * (draft.height / along);
        for (std::uint32_t color = options.per_color ? 1 : 0; color <= (options.per_color ? 3u : 0u); ++color) {
            glm::vec3 intensity(0.0f);
            for (std::uint32_t c = 0; c < 3; ++c)
                if (color == 0 || color == c + 1) intensity[int(c)] = light.intensity[int(c)];
            if (!(brightest(intensity) > 0.0)) continue;
            result.fronts.push_back(
                {.corner = glm::vec4(glm::vec3(draft.corner), float(across)),
                 .side = glm::vec4(glm::vec3(draft.side / across), float(along)),
                 .up = glm::vec4(glm::vec3(draft.up / along), 0.0f),
                 .position = glm::vec4(light.position, float(draft.start)),
                 .direction = glm::vec4(light.direction, float(light.kind)),
                 .intensity = glm::vec4(intensity, float(brightest(intensity) * share)),
                 .cone = glm::vec4(std::cos(light.inner_cone_angle), std::cos(light.outer_cone_angle),
                                   std::bit_cast<float>(draft.volume), std::bit_cast<float>(color))});
        }
    }
    return result;
}

}  // namespace pellucid
