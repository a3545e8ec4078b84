#include "reference/curved_volumes.h"

#include "reference/placed_volume.h"
#include "reference/punctual_lights.h"

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

constexpr double kStepTolerance = 1e-7;      // tolerance per step: relative, and absolute in voxels
constexpr double kLongestStep = 1.0;     // voxels; surfaces are intersected along the step's chord
constexpr double kLeastCrossing = 1e-3;  // voxels; shorter segments in a box are skipped
constexpr double kMostSides = 32.0;      // longest optical path in a box, in its longest sides; longer rays are trapped
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

Hit next_hit(const Geometry& geometry, const Query& query, const SizedLights* lights, const Light*& ball) {
    return lights ? lights->intersect(geometry, query, ball) : geometry.intersect(query);
}

}  // namespace

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
        placed->reflects = object.objects.empty() && !volume->boundary.empty();
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

CurvedVolumes::Flight CurvedVolumes::fly(std::int32_t solid, const Geometry& geometry, Query& query, int channel,
                                         Random* random, const SizedLights* lights) const {
    const List& volumes = volumes_of(solid);
    Flight flight;
    for (;;) {
        double to_box = 0.0;
        const std::size_t volume = next_volume(volumes, query.origin, query.direction, to_box);
        const double t_max = query.t_max;
        query.t_max = std::min(to_box, t_max);
        flight.hit = next_hit(geometry, query, lights, flight.ball);
        query.t_max = t_max;
        if (flight.hit.found || volume == kNone || to_box >= t_max) return flight;
        if (to_box > 0.0) query.standing = {};
        query.origin += to_box * query.direction;
        query.t_max -= to_box;
        flight.length += to_box;
        flight.met = true;
        flight.ior = flight.basic = 1.0;
        if (bend(volumes, volume, geometry, query, channel, random, lights, flight)) return flight;
    }
}

/// Follows a ray from a point in a box to a surface (returns true) or to its exit from the box (returns false).
bool CurvedVolumes::bend(const List& volumes, std::size_t own, const Geometry& geometry, Query& query, int channel,
                         Random* random, const SizedLights* lights, Flight& flight) {
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
    // Share of a step's chord that lies in the box, and before the box of a smaller volume.
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

    // A ray meets a surface at the largest boundary value between two steps.
    constexpr double kLeastSurface = 0.5;
    double surface_here = placed.reflects ? placed.surface(start) : 0.0;
    bool on_surface = surface_here > kLeastSurface;  // the surface here was already met
    const auto meet_surface = [&](Values& here) {
        glm::dvec3 normal;
        const std::optional<double> share = placed.reflectance(here, normal, channel);
        if (!share) return;
        if (random == nullptr) {  // follow the transmitted path
            for (std::size_t k = 6; k < 9; ++k) here[k] -= std::log1p(-*share);
            return;
        }
        if (random->next() >= *share) return;
        const glm::dvec3 back = glm::reflect(velocity_of(here), normal);
        for (int k = 0; k < 3; ++k) here[std::size_t(3 + k)] = back[k];
    };
    auto stepper = odeint::make_controlled(kStepTolerance, kStepTolerance, odeint::runge_kutta_dopri5<Values>());
    double time = 0.0, step = 0.25;
    const double longest = kMostSides * std::max({placed.size.x, placed.size.y, placed.size.z});
    while (time < longest) {
        step = std::min(step, kLongestStep);
        Values next = state;
        double taken = step;
        if (stepper.try_step(system, next, time, step) == odeint::fail) continue;
        if (placed.reflects) {
            const double ahead = placed.surface(position_of(next));
            if (surface_here < kLeastSurface) on_surface = false;
            if (!on_surface && surface_here >= ahead && surface_here > kLeastSurface) {
                on_surface = true;
                meet_surface(state);
                stepper.reset();
                continue;  // continue from here
            }
            surface_here = ahead;
        }
        bool leaves = false;
        double share = share_of(state, next, leaves);
        for (int refine = 0; leaves && refine < 4; ++refine) {  // refine the step's length until it ends at the exit
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
            flight.hit = next_hit(geometry, query, lights, flight.ball);
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
