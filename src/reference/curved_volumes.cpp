#include "reference/curved_volumes.h"

#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pellucid::reference {
namespace {

namespace odeint = boost::numeric::odeint;

constexpr double kTolerance = 1e-7;      // of a step, relative, and absolute in voxels
constexpr double kLongestStep = 1.0;     // voxels: surfaces are looked for along its chord
constexpr double kLeastCrossing = 1e-3;  // voxels; less of a box is not met
constexpr double kMostSides = 32.0;      // longest ways in a box, in its longest side: what goes farther is caught
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// Position (voxels), v = n dx/ds, optical depths, and what was emitted on the way, attenuated.
using Values = std::array<double, 12>;

glm::dvec3 position_of(const Values& s) { return {s[0], s[1], s[2]}; }
glm::dvec3 velocity_of(const Values& s) { return {s[3], s[4], s[5]}; }

struct Index {
    double n = 1.0;
    glm::dvec3 gradient{0.0};  ///< per voxel
};

/// Of a uniform cubic B-spline at f, 0..1, between the second and the third of four values: their weights, and those of its
/// slope. Before the first value and behind the last a row goes on straight.
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

}  // namespace

struct CurvedVolumes::Placed {
    std::shared_ptr<const Volume> volume;
    glm::dmat4 world_from_voxel, voxel_from_world;
    double voxel = 1.0;  ///< edge, m in the world
    glm::dvec3 size;     ///< voxels

    /// Between the middles of voxels, from that of the first; beyond those at the faces all is as there.
    struct Cell {
        glm::ivec3 low;
        glm::dvec3 share;
        glm::dvec3 within;  ///< 0 along an axis on which the place is beyond
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

    /// Cells of the grid in cubes of kBrick, as those of `cell()`; whether the index is the same in all of one, and in
    /// what is next to it.
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
        std::size_t first[3][4];  // of the values at -1, 0, 1, 2 along each axis
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

    glm::dvec3 linear(const std::vector<glm::vec3>& values, const Cell& at) const {
        if (values.empty()) return glm::dvec3(0.0);
        glm::dvec3 sum(0.0);
        for (int k = 0; k < 8; ++k) {
            const glm::ivec3 offset(k & 1, k >> 1 & 1, k >> 2);
            const glm::dvec3 w = glm::mix(1.0 - at.share, at.share, glm::dvec3(offset));
            sum += w.x * w.y * w.z * glm::dvec3(values[number(at.low + offset)]);
        }
        return sum;
    }

    /// By a voxel of length.
    void slope(const Values& s, Values& ds, int channel) const {
        const Cell here = cell(position_of(s));
        const Index at = index(here, channel);
        const glm::dvec3 v = velocity_of(s);
        const glm::dvec3 extinction = linear(volume->sigma_a, here) + linear(volume->sigma_s, here);
        const glm::dvec3 emission = linear(volume->emission, here) / (at.n * at.n);
        const double metres = double(volume->voxel);  // a scaled placement leaves what it absorbs in all
        for (std::size_t k = 0; k < 3; ++k) {
            const int c = int(k);
            ds[k] = v[c] / at.n;
            ds[3 + k] = at.gradient[c];
            ds[6 + k] = metres * extinction[c];
            ds[9 + k] = metres * emission[c] * std::exp(-s[6 + k]);
        }
    }
};

CurvedVolumes::CurvedVolumes(const Scene& scene, const Geometry& geometry) {
    for (const VolumeObject& object : scene.volume_objects) {
        const std::shared_ptr<const Volume>& volume = scene.volumes[std::size_t(object.volume)];
        auto placed = std::make_shared<Placed>();
        placed->volume = volume;
        placed->size = glm::dvec3(volume->size);
        glm::dmat4 volume_from_voxel(double(volume->voxel));
        volume_from_voxel[3] = glm::dvec4(glm::dvec3(volume->low), 1.0);
        placed->world_from_voxel = glm::dmat4(object.world_from_volume) * volume_from_voxel;
        placed->voxel_from_world = glm::inverse(placed->world_from_voxel);
        placed->voxel = glm::length(glm::dvec3(placed->world_from_voxel[0]));
        placed->find_even_bricks();
        if (object.objects.empty())
            open_.push_back(std::move(placed));
        else
            held_[std::int32_t(geometry.solid_of(geometry.shell(std::uint32_t(object.objects.front()), 0)))].push_back(
                std::move(placed));
    }
    const auto content = [](const Placed& p) { return p.size.x * p.size.y * p.size.z * p.voxel * p.voxel * p.voxel; };
    const auto sort = [&](List& list) {
        std::stable_sort(list.begin(), list.end(),
                         [&](const auto& a, const auto& b) { return content(*a) < content(*b); });
    };
    sort(open_);
    for (auto& [solid, list] : held_) sort(list);
}

const CurvedVolumes::List& CurvedVolumes::volumes_of(std::int32_t solid) const {
    static const List kNoVolumes;
    if (solid == kAir) return open_;
    const auto found = held_.find(solid);
    return found == held_.end() ? kNoVolumes : found->second;
}

std::optional<double> CurvedVolumes::index_at(std::int32_t solid, const glm::dvec3& position, int channel) const {
    if (solid == kAir) return std::nullopt;
    for (const auto& placed : volumes_of(solid)) {
        const glm::dvec3 x(placed->voxel_from_world * glm::dvec4(position, 1.0));
        if (glm::any(glm::lessThan(x, glm::dvec3(-kLeastCrossing))) ||
            glm::any(glm::greaterThan(x, placed->size + kLeastCrossing)))
            continue;
        return placed->index(x, channel).n;
    }
    return std::nullopt;
}

CurvedVolumes::Span CurvedVolumes::crossing(const Placed& placed, const glm::dvec3& origin,
                                            const glm::dvec3& direction) {
    const glm::dvec3 x(placed.voxel_from_world * glm::dvec4(origin, 1.0));
    const glm::dvec3 d = glm::dmat3(placed.voxel_from_world) * direction;
    Span span{0.0, std::numeric_limits<double>::infinity()};
    for (int k = 0; k < 3; ++k) {
        if (d[k] == 0.0) {
            if (x[k] < 0.0 || x[k] > placed.size[k]) return {};
            continue;
        }
        const double a = -x[k] / d[k], b = (placed.size[k] - x[k]) / d[k];
        span.near = std::max(span.near, std::min(a, b));
        span.far = std::min(span.far, std::max(a, b));
    }
    return span.far - span.near > kLeastCrossing * placed.voxel ? span : Span{};
}

std::size_t CurvedVolumes::next_volume(const List& volumes, const glm::dvec3& origin, const glm::dvec3& direction,
                                       double& distance) {
    std::size_t found = kNone;
    distance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        const Span span = crossing(*volumes[i], origin, direction);
        if (span.far > span.near && span.near < distance) {
            distance = span.near;
            found = i;
        }
    }
    return found;
}

bool CurvedVolumes::disperses() const {
    const auto parts = [](const List& list) {
        return std::any_of(list.begin(), list.end(), [](const auto& p) { return !p->volume->n_red.empty(); });
    };
    return parts(open_) ||
           std::any_of(held_.begin(), held_.end(), [&](const auto& held) { return parts(held.second); });
}

bool CurvedVolumes::meets(const glm::dvec3& origin, const glm::dvec3& direction, double distance) const {
    double to_box = 0.0;
    return next_volume(open_, origin, direction, to_box) != kNone && to_box < distance;
}

CurvedVolumes::Flight CurvedVolumes::fly(std::int32_t solid, const Geometry& geometry, Query& query,
                                         int channel) const {
    const List& volumes = volumes_of(solid);
    Flight flight;
    for (;;) {
        double to_box = 0.0;
        const std::size_t volume = next_volume(volumes, query.origin, query.direction, to_box);
        const double t_max = query.t_max;
        query.t_max = std::min(to_box, t_max);
        flight.hit = geometry.intersect(query);
        query.t_max = t_max;
        if (flight.hit.found || volume == kNone || to_box >= t_max) return flight;
        if (to_box > 0.0) query.standing = {};
        query.origin += to_box * query.direction;
        query.t_max -= to_box;
        flight.length += to_box;
        flight.met = true;
        flight.ior = flight.basic = 1.0;
        if (bend(volumes, volume, geometry, query, channel, flight)) return flight;
    }
}

/// From where a ray is in a box, to a surface (true), or to where it leaves the box.
bool CurvedVolumes::bend(const List& volumes, std::size_t own, const Geometry& geometry, Query& query, int channel,
                         Flight& flight) {
    const Placed& placed = *volumes[own];
    const auto world = [&](const Values& s) {
        return glm::dvec3(placed.world_from_voxel * glm::dvec4(position_of(s), 1.0));
    };
    const glm::dmat3 turn = glm::dmat3(placed.world_from_voxel) / placed.voxel;
    const auto system = [&](const Values& s, Values& ds, double) { placed.slope(s, ds, channel); };
    const glm::dvec3 start =
        glm::clamp(glm::dvec3(placed.voxel_from_world * glm::dvec4(query.origin, 1.0)), glm::dvec3(0.0), placed.size);
    const double n = placed.index(start, channel).n;
    const glm::dvec3 v = n * (query.direction * turn);
    Values state{start.x, start.y, start.z, v.x, v.y, v.z, 0, 0, 0, 0, 0, 0};
    const auto after = [&](const Values& from, double step) {
        Values to = from;
        odeint::runge_kutta_dopri5<Values>().do_step(system, to, 0.0, step);
        return to;
    };
    // Of the chord of a step, the share in the box, and before the box of a smaller volume.
    const auto share_of = [&](const Values& from, const Values& to, bool& leaves) {
        const glm::dvec3 a = position_of(from), way = position_of(to) - a;
        double share = 1.0;
        for (int k = 0; k < 3; ++k) {
            if (way[k] > 0.0) share = std::min(share, (placed.size[k] - a[k]) / way[k]);
            if (way[k] < 0.0) share = std::min(share, -a[k] / way[k]);
        }
        const glm::dvec3 origin = world(from);
        const double length = glm::length(way) * placed.voxel;
        for (std::size_t i = 0; i < own && length > 0.0; ++i) {
            const Span span = crossing(*volumes[i], origin, (world(to) - origin) / length);
            if (span.far > span.near) share = std::min(share, span.near / length);
        }
        leaves = share < 1.0;
        return std::max(share, 0.0);
    };
    const auto add = [&](const Values& s) {
        flight.emission += n * n * flight.transmittance * glm::dvec3(s[9], s[10], s[11]);
        flight.transmittance *= glm::dvec3(std::exp(-s[6]), std::exp(-s[7]), std::exp(-s[8]));
    };

    auto stepper = odeint::make_controlled(kTolerance, kTolerance, odeint::runge_kutta_dopri5<Values>());
    double time = 0.0, step = 0.25;
    const double longest = kMostSides * std::max({placed.size.x, placed.size.y, placed.size.z});
    while (time < longest) {
        step = std::min(step, kLongestStep);
        Values next = state;
        double taken = step;
        if (stepper.try_step(system, next, time, step) == odeint::fail) continue;
        bool leaves = false;
        double share = share_of(state, next, leaves);
        for (int refine = 0; leaves && refine < 4; ++refine) {  // the curve's own length, where the chord leaves
            taken *= share;
            next = after(state, taken);
            bool further = false;
            share = share_of(state, next, further);
            if (!further) break;
        }
        const glm::dvec3 from = world(state), chord = world(next) - from;
        const double length = glm::length(chord);
        if (length > 0.0) {
            query.origin = from;
            query.direction = chord / length;
            const double t_max = query.t_max;
            query.t_max = std::min(t_max, length);
            flight.hit = geometry.intersect(query);
            query.t_max = t_max;
            if (flight.hit.found) {
                const Values at = after(state, taken * std::min(flight.hit.t / length, 1.0));
                query.direction = glm::normalize(turn * velocity_of(at));
                flight.ior = placed.index(position_of(at), channel).n;
                flight.basic = n * n / (flight.ior * flight.ior);
                flight.length_inside += flight.hit.t;
                flight.ends_inside = true;
                add(at);
                return true;
            }
            query.standing = {};
            query.t_max -= length;
            flight.length += length;
            flight.length_inside += length;
        }
        state = next;
        if (!leaves) continue;
        query.origin = world(state);
        query.direction = glm::normalize(turn * velocity_of(state));
        flight.left_at = query.origin;
        flight.left_after = flight.length;
        add(state);
        return false;
    }
    flight.stuck = true;
    flight.hit.found = false;
    query.direction = glm::normalize(turn * velocity_of(state));
    add(state);
    return true;
}

}  // namespace pellucid::reference
