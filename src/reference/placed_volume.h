#pragma once

#include "reference/curved_volumes.h"
#include "reference/dielectric.h"

#include <pellucid/volume.h>

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

namespace pellucid::reference {

/// State of the integration: position (voxels), v = n dx/ds, optical depths, and attenuated emission along the path.
using Values = std::array<double, 12>;

inline glm::dvec3 position_of(const Values& s) { return {s[0], s[1], s[2]}; }
inline glm::dvec3 velocity_of(const Values& s) { return {s[3], s[4], s[5]}; }

struct Index {
    double n = 1.0;
    glm::dvec3 gradient{0.0};  ///< per voxel
};

/// Uniform cubic B-spline at f, 0..1, between the second and third of four values: weights of the values and of the
/// slope. At the first and last value the row is extrapolated linearly.
struct Cubic {
    std::array<double, 4> weight, slope;

    Cubic(double f, bool first, bool last) {
        const double g = 1.0 - f;
        weight = {g * g * g / 6.0, (1.0 + 3.0 * g * (1.0 + g * f)) / 6.0, (1.0 + 3.0 * f * (1.0 + f * g)) / 6.0,
                  f * f * f / 6.0};
        slope = {-0.5 * g * g, 0.5 * f * (f - 2.0 * g - 2.0), 0.5 * g * (2.0 * f + 2.0 - g), 0.5 * f * f};
        for (std::array<double, 4>* row : {&weight, &slope}) {
            auto& [a, b, c, d] = *row;
            if (first) b += 2.0 * a, c -= a, a = 0.0;
            if (last) c += 2.0 * d, b -= d, d = 0.0;
        }
    }
};

/// A placed volume of a scene: its values at a position, and the derivative of a ray there. Positions are in voxels.
struct CurvedVolumes::Placed {
    std::shared_ptr<const Volume> volume;
    glm::dmat4 world_from_voxel, voxel_from_world;
    double voxel = 1.0;     ///< edge, m in world space
    glm::dvec3 size;        ///< voxels
    bool reflects = false;  ///< has blurred surfaces; false if assigned to a solid, whose surfaces are sharp

    /// Interpolation cell between voxel centres. Beyond the outermost centres, values are constant.
    struct Cell {
        glm::ivec3 low;
        glm::dvec3 share;
        glm::dvec3 within;  ///< 0 along axes where the position is beyond the outermost centres
    };
    Cell cell(const glm::dvec3& x) const {
        const glm::dvec3 last = size - 1.0, p = glm::clamp(x - 0.5, glm::dvec3(0.0), last);
        const glm::dvec3 low = glm::min(glm::floor(p), size - 2.0);
        Cell at{glm::ivec3(low), p - low, glm::dvec3(1.0)};
        for (int k = 0; k < 3; ++k)
            if (x[k] < 0.5 || x[k] > size[k] - 0.5) at.within[k] = 0.0;
        return at;
    }
    std::size_t number(glm::ivec3 at) const {
        at = glm::clamp(at, glm::ivec3(0), glm::ivec3(volume->size) - 1);
        return std::size_t(at.x) + volume->size.x * (std::size_t(at.y) + volume->size.y * std::size_t(at.z));
    }

    /// Bricks of kBrick^3 cells. `even` is 1 if the index is constant in a brick and its neighbourhood.
    static constexpr int kBrick = 8;
    glm::ivec3 bricks{0};
    std::vector<char> even;
    std::size_t brick(const glm::ivec3& low) const {
        const glm::ivec3 b = low / kBrick;
        return std::size_t(b.x) + std::size_t(bricks.x) * (std::size_t(b.y) + std::size_t(bricks.y) * std::size_t(b.z));
    }
    void find_even_bricks() {
        bricks = (glm::ivec3(volume->size) + kBrick - 1) / kBrick;
        even.assign(std::size_t(bricks.x) * std::size_t(bricks.y) * std::size_t(bricks.z), 1);
        for (const std::vector<float>* values : {&volume->n, &volume->n_red, &volume->n_blue}) {
            if (values->empty()) continue;
            glm::ivec3 b;
            for (b.z = 0; b.z < bricks.z; ++b.z)
                for (b.y = 0; b.y < bricks.y; ++b.y)
                    for (b.x = 0; b.x < bricks.x; ++b.x)
                        even[brick(kBrick * b)] = even[brick(kBrick * b)] != 0 && same_in(*values, kBrick * b) ? 1 : 0;
        }
    }
    bool same_in(const std::vector<float>& values, const glm::ivec3& low) const {
        const float first = values[number(low)];
        glm::ivec3 at;
        for (at.z = low.z - 1; at.z < low.z + kBrick + 2; ++at.z)
            for (at.y = low.y - 1; at.y < low.y + kBrick + 2; ++at.y)
                for (at.x = low.x - 1; at.x < low.x + kBrick + 2; ++at.x)
                    if (values[number(at)] != first) return false;
        return true;
    }

    Index index(const glm::dvec3& x, int channel) const {
        return volume->n.empty() ? Index{} : index(cell(x), channel);
    }
    Index index(const Cell& at, int channel) const {
        if (volume->n.empty()) return {};
        const bool parted = !volume->n_red.empty();
        const std::vector<float>& values = parted && channel == kRed    ? volume->n_red
                                           : parted && channel == kBlue ? volume->n_blue
                                                                        : volume->n;
        if (even[brick(at.low)] != 0) return {double(values[number(at.low)]), glm::dvec3(0.0)};
        const auto cubic_along = [&](int k) {
            return Cubic(at.share[k], at.low[k] == 0, at.low[k] + 2 == int(volume->size[k]));
        };
        const Cubic cx = cubic_along(0), cy = cubic_along(1), cz = cubic_along(2);
        std::size_t first[3][4];  // offsets of the values at -1, 0, 1, 2 along each axis
        std::size_t stride = 1;
        for (int k = 0; k < 3; ++k) {
            for (int i = 0; i < 4; ++i)
                first[k][i] = stride * std::size_t(std::clamp(at.low[k] + i - 1, 0, int(volume->size[k]) - 1));
            stride *= volume->size[k];
        }
        Index sum{0.0, glm::dvec3(0.0)};
        for (std::size_t z = 0; z < 4; ++z) {
            for (std::size_t y = 0; y < 4; ++y) {
                const float* const row = values.data() + first[2][z] + first[1][y];
                double value = 0.0, along = 0.0;
                for (std::size_t i = 0; i < 4; ++i) {
                    const double n = double(row[first[0][i]]);
                    value += cx.weight[i] * n;
                    along += cx.slope[i] * n;
                }
                sum.n += cy.weight[y] * cz.weight[z] * value;
                sum.gradient += glm::dvec3(cy.weight[y] * cz.weight[z] * along, cy.slope[y] * cz.weight[z] * value,
                                           cy.weight[y] * cz.slope[z] * value);
            }
        }
        sum.gradient *= at.within;
        return sum;
    }

    template <class T>  // scalars become grey
    glm::dvec3 linear(const std::vector<T>& values, const Cell& at) const {
        if (values.empty()) return glm::dvec3(0.0);
        glm::dvec3 sum(0.0);
        for (int k = 0; k < 8; ++k) {
            const glm::ivec3 offset(k & 1, k >> 1 & 1, k >> 2);
            const glm::dvec3 w = glm::mix(1.0 - at.share, at.share, glm::dvec3(offset));
            sum += w.x * w.y * w.z * glm::dvec3(values[number(at.low + offset)]);
        }
        return sum;
    }

    /// Boundary value, 0..1.
    double surface(const glm::dvec3& x) const { return linear(volume->boundary, cell(x)).x; }
    /// Index on one side of a surface: searched from its middle to where the surface ends, or the next begins.
    double index_beside(const glm::dvec3& middle, const glm::dvec3& way, int channel) const {
        constexpr double kStep = 0.25, kFarthest = 8.0, kEnds = 0.01;
        double before = surface(middle);
        glm::dvec3 x = middle;
        for (double t = kStep; t < kFarthest; t += kStep) {
            const glm::dvec3 next = middle + t * way;
            const double here = surface(next);
            if (here > before && before < 0.5) break;
            x = next;
            before = here;
            if (here < kEnds) break;
        }
        return index(x, channel).n;
    }
    /// Fresnel reflectance of a surface for a ray near its middle; empty if the ray turns back there. The component of
    /// v along the surface is equal on both sides.
    std::optional<double> reflectance(const Values& s, glm::dvec3& normal, int channel) const {
        const glm::dvec3 x = position_of(s), v = velocity_of(s), gradient = index(x, channel).gradient;
        if (!(glm::length(gradient) > 1e-3)) return std::nullopt;
        normal = glm::normalize(gradient);
        const double across = glm::dot(v, normal), along = glm::dot(v, v) - across * across;
        const glm::dvec3 forward = across > 0.0 ? normal : -normal;
        const double n_i = index_beside(x, -forward, channel), n_t = index_beside(x, forward, channel);
        if (along >= n_t * n_t || along >= n_i * n_i) return std::nullopt;
        const double a = std::sqrt(n_i * n_i - along), b = std::sqrt(n_t * n_t - along);  // n cos theta on either side
        return fresnel_reflectance(n_i, a / n_i, n_t, b / n_t);
    }

    /// Derivative with respect to length, per voxel.
    void slope(const Values& s, Values& ds, int channel) const {
        const Cell here = cell(position_of(s));
        const Index at = index(here, channel);
        const glm::dvec3 v = velocity_of(s);
        const glm::dvec3 extinction = linear(volume->sigma_a, here) + linear(volume->sigma_s, here);
        const glm::dvec3 emission = linear(volume->emission, here) / (at.n * at.n);
        const double metres = double(volume->voxel);  // a scaled placement keeps the total absorption
        for (std::size_t k = 0; k < 3; ++k) {
            const int c = int(k);
            ds[k] = v[c] / at.n;
            ds[3 + k] = at.gradient[c];
            ds[6 + k] = metres * extinction[c];
            ds[9 + k] = metres * emission[c] * std::exp(-s[6 + k]);
        }
    }
};

}  // namespace pellucid::reference
