#include "closed_form/closed_form_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace pellucid::closed_form {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kContact = 1e-6;      // of the larger body's extent
constexpr double kVolumeTie = 1e-4;    // relative
constexpr double kLeastCosine = 0.02;  // a flatter ray does not stretch a contact any further

/// Where a ray is inside a shell, in multiples of its direction, and the outward normals there.
struct Interval {
    double t[2];
    glm::dvec3 normal[2];  ///< in the shell's own frame, of any length
};

std::optional<Interval> ball_interval(const glm::dvec3& o, const glm::dvec3& d) {
    const double a = glm::dot(d, d), b = glm::dot(o, d);
    const glm::dvec3 nearest = o - (b / a) * d;  // the discriminant from here loses no digits far away
    const double discriminant = (1.0 - glm::dot(nearest, nearest)) * a;
    if (!(discriminant > 0.0)) return std::nullopt;
    const double root = std::sqrt(discriminant);
    Interval hit{{(-b - root) / a, (-b + root) / a}, {}};
    for (int k = 0; k < 2; ++k) hit.normal[k] = o + hit.t[k] * d;
    return hit;
}

std::optional<Interval> box_interval(const glm::dvec3& o, const glm::dvec3& d) {
    Interval hit{{-kInfinity, kInfinity}, {}};
    for (int axis = 0; axis < 3; ++axis) {
        if (d[axis] == 0.0) {
            if (std::abs(o[axis]) >= 1.0) return std::nullopt;
            continue;
        }
        const double side = d[axis] > 0.0 ? 1.0 : -1.0;
        const double in = (-side - o[axis]) / d[axis], out = (side - o[axis]) / d[axis];
        glm::dvec3 normal(0.0);
        normal[axis] = side;
        if (in > hit.t[0]) hit.t[0] = in, hit.normal[0] = -normal;
        if (out < hit.t[1]) hit.t[1] = out, hit.normal[1] = normal;
    }
    if (!(hit.t[0] < hit.t[1])) return std::nullopt;
    return hit;
}

double reflectance(double n_i, double cos_i, double n_t, double cos_t) {
    const double s = (n_i * cos_i - n_t * cos_t) / (n_i * cos_i + n_t * cos_t);
    const double p = (n_t * cos_i - n_i * cos_t) / (n_t * cos_i + n_i * cos_t);
    return 0.5 * (s * s + p * p);
}

glm::dvec3 absorb(const glm::dvec3& sigma_a, double length) { return glm::exp(-length * sigma_a); }

double unit_volume(ShellKind kind) { return kind == ShellKind::kBall ? 4.1887902047863909846 : 8.0; }

}  // namespace

glm::dvec3 half_box(const Shell& shell) {
    const glm::dmat3 m(shell.world_from_shell);
    glm::dvec3 half;
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 row(m[0][axis], m[1][axis], m[2][axis]);
        half[axis] =
            shell.kind == ShellKind::kBall ? glm::length(row) : std::abs(row.x) + std::abs(row.y) + std::abs(row.z);
    }
    return half;
}

bool contains(const Shell& shell, const glm::dvec3& point) {
    const glm::dvec3 p(glm::inverse(shell.world_from_shell) * glm::dvec4(point, 1.0));
    if (shell.kind == ShellKind::kBall) return glm::dot(p, p) < 1.0;
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 1.0;
}

double material_volume(const std::vector<Shell>& shells, int cells) {
    const auto own = [](const Shell& s) {
        return unit_volume(s.kind) * std::abs(glm::determinant(glm::dmat3(s.world_from_shell)));
    };
    if (shells.size() == 1) return own(shells.front());
    glm::dvec3 low(kInfinity), high(-kInfinity);
    std::vector<glm::dmat4> inverse;
    for (const Shell& shell : shells) {
        low = glm::min(low, glm::dvec3(shell.world_from_shell[3]) - half_box(shell));
        high = glm::max(high, glm::dvec3(shell.world_from_shell[3]) + half_box(shell));
        inverse.push_back(glm::inverse(shell.world_from_shell));
    }
    const glm::dvec3 cell = (high - low) / double(cells);
    double columns = 0.0;  // lengths along Z of columns of cells, exact along Z
    for (int i = 0; i < cells * cells; ++i) {
        const glm::dvec3 origin = low + cell * glm::dvec3(i % cells + 0.5, i / cells + 0.5, 0.0);
        std::vector<std::pair<double, int>> steps;
        for (std::size_t s = 0; s < shells.size(); ++s) {
            const glm::dvec3 o(inverse[s] * glm::dvec4(origin, 1.0)), d(inverse[s][2]);
            const auto hit = shells[s].kind == ShellKind::kBall ? ball_interval(o, d) : box_interval(o, d);
            if (!hit) continue;
            steps.emplace_back(hit->t[0], shells[s].winding);
            steps.emplace_back(hit->t[1], -shells[s].winding);
        }
        std::sort(steps.begin(), steps.end());
        int winding = 0;
        for (std::size_t k = 0; k + 1 < steps.size(); ++k) {
            winding += steps[k].second;
            if (winding > 0) columns += steps[k + 1].first - steps[k].first;
        }
    }
    return columns * cell.x * cell.y;
}

Ray View::ray(glm::dvec2 point_px, int size) const {
    const double pixel = (orthographic ? vertical_extent : 2.0 * std::tan(0.5 * vertical_fov)) / size;
    const glm::dvec2 film((point_px.x - 0.5 * size) * pixel, (0.5 * size - point_px.y) * pixel);
    const glm::dvec4 eye = orthographic ? glm::dvec4(film, 0.0, 1.0) : glm::dvec4(0.0, 0.0, 0.0, 1.0);
    const glm::dvec3 along = orthographic ? glm::dvec3(0.0, 0.0, -1.0) : glm::dvec3(film, -1.0);
    return {glm::dvec3(world_from_view * eye), glm::normalize(glm::dmat3(world_from_view) * along)};
}

int Path::reflections() const {
    return int(std::count_if(events.begin(), events.end(), [](const Event& event) { return event.total; }));
}

Scene::Scene(std::vector<Body> bodies) : bodies_(std::move(bodies)), rank_(bodies_.size()) {
    for (const Body& body : bodies_) {
        glm::dvec3 low(kInfinity), high(-kInfinity);
        std::vector<glm::dmat4>& inverse = shell_from_world_.emplace_back();
        for (const Shell& shell : body.shells) {
            low = glm::min(low, glm::dvec3(shell.world_from_shell[3]) - half_box(shell));
            high = glm::max(high, glm::dvec3(shell.world_from_shell[3]) + half_box(shell));
            inverse.push_back(glm::inverse(shell.world_from_shell));
        }
        const glm::dvec3 size = high - low;
        extents_.push_back(std::max({size.x, size.y, size.z}));
    }
    // Ties make the order of volumes intransitive in theory; test scenes keep volumes apart or equal.
    std::vector<int> order(bodies_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int i, int j) {
        const Body &a = bodies_[std::size_t(i)], &b = bodies_[std::size_t(j)];
        if (a.priority != b.priority) return a.priority < b.priority;
        if (std::abs(a.volume - b.volume) > kVolumeTie * std::max(a.volume, b.volume)) return a.volume > b.volume;
        return i < j;
    });
    for (std::size_t k = 0; k < order.size(); ++k) rank_[std::size_t(order[k])] = int(k);
}

const Medium& Scene::medium(int body) const {
    static const Medium kAir{};
    return body == kOutside ? kAir : bodies_[std::size_t(body)].medium;
}

std::vector<int> Scene::windings(const glm::dvec3& point) const {
    std::vector<int> windings(bodies_.size(), 0);
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        for (const Shell& shell : bodies_[b].shells) windings[b] += contains(shell, point) ? shell.winding : 0;
    return windings;
}

int Scene::body_at(const glm::dvec3& point) const {
    const std::vector<int> winding = windings(point);
    int top = kOutside;
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        if (winding[b] > 0 && (top == kOutside || rank_[b] > rank_[std::size_t(top)])) top = int(b);
    return top;
}

std::vector<Scene::Crossing> Scene::crossings(const Ray& ray) const {
    std::vector<Crossing> all;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        for (std::size_t s = 0; s < bodies_[b].shells.size(); ++s) {
            const glm::dmat4& m = shell_from_world_[b][s];
            const glm::dvec3 o(m * glm::dvec4(ray.origin, 1.0)), d(glm::dmat3(m) * ray.direction);
            const auto hit = bodies_[b].shells[s].kind == ShellKind::kBall ? ball_interval(o, d) : box_interval(o, d);
            if (!hit) continue;
            for (int k = 0; k < 2; ++k) {
                const glm::dvec3 normal = glm::normalize(glm::transpose(glm::dmat3(m)) * hit->normal[k]);
                all.push_back({hit->t[k], std::abs(glm::dot(normal, ray.direction)), int(b), normal});
            }
        }
    }
    std::sort(all.begin(), all.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
    return all;
}

/// The gap is measured across the surfaces, so that a flat ray between two faces does not widen it.
bool Scene::in_contact(const Crossing& a, const Crossing& b) const {
    const double across = std::max(std::min(a.cos_theta, b.cos_theta), kLeastCosine);
    const double extent = std::max(extents_[std::size_t(a.body)], extents_[std::size_t(b.body)]);
    return std::abs(b.t - a.t) * across <= kContact * extent;
}

/// `start`: the surface on which the ray begins; what touches it is behind the ray.
Scene::Interface Scene::next_interface(const Ray& ray, const Crossing* start) const {
    const std::vector<Crossing> all = crossings(ray);
    std::size_t i = 0;
    if (!start) {
        while (i < all.size() && all[i].t <= 0.0) ++i;
    } else {
        // Contact is a chain: a surface that touches one that touches the start is at the start.
        Crossing last = *start;
        while (i < all.size() && (all[i].t < 0.0 || in_contact(last, all[i]))) {
            if (all[i].t >= 0.0) last = all[i];
            ++i;
        }
    }
    Interface next;
    const auto middle = [&](double a, double b) { return ray.origin + 0.5 * (a + b) * ray.direction; };
    double from = i > 0 && start ? std::max(all[i - 1].t, 0.0) : 0.0;
    while (i < all.size()) {
        std::size_t end = i + 1;
        while (end < all.size() && in_contact(all[end - 1], all[end])) ++end;
        const double beyond = end < all.size() ? all[end].t : all[end - 1].t + 1.0;
        next.before = body_at(middle(from, all[i].t));
        next.after = body_at(middle(all[end - 1].t, beyond));
        // Air has an interface with whatever is like it, too.
        const bool both = next.before != kOutside && next.after != kOutside;
        if (both ? !(medium(next.before) == medium(next.after)) : next.before != next.after) {
            // The surface of a body that is left or entered bends the ray, not one that merely touches it.
            std::size_t at = i;
            while (at < end && all[at].body != next.before && all[at].body != next.after) ++at;
            if (at == end) at = i;
            next.found = true;
            next.t = all[at].t;
            next.normal = all[at].normal;
            return next;
        }
        from = all[end - 1].t;
        i = end;
    }
    return next;
}

Path Scene::trace(const Ray& from, int max_events) const {
    Path path;
    Ray ray = from;
    Crossing start{};
    for (bool first = true;; first = false) {
        path.direction = ray.direction;
        const Interface at = next_interface(ray, first ? nullptr : &start);
        if (!at.found) return path;
        const Medium &here = medium(at.before), &there = medium(at.after);
        path.transmittance *= absorb(here.sigma_a, at.t);
        path.length += at.t;
        if (at.before != kOutside) path.length_inside += at.t;
        if (int(path.events.size()) == max_events) {
            path.cut = true;
            return path;
        }
        Event event{at.before, at.after, false, ray.origin + at.t * ray.direction};
        const glm::dvec3 n = glm::dot(ray.direction, at.normal) < 0.0 ? at.normal : -at.normal;
        const double eta = here.ior / there.ior, cos_i = -glm::dot(ray.direction, n);
        const double cos2_t = 1.0 - eta * eta * (1.0 - cos_i * cos_i);
        event.total = cos2_t < 0.0;
        if (event.total) {
            ray.direction += 2.0 * cos_i * n;
        } else {
            const double cos_t = std::sqrt(cos2_t);
            path.transmittance *= 1.0 - reflectance(here.ior, cos_i, there.ior, cos_t);
            ray.direction = eta * ray.direction + (eta * cos_i - cos_t) * n;
        }
        ray.direction = glm::normalize(ray.direction);
        ray.origin = event.position;
        path.events.push_back(event);
        const int owner = at.before != kOutside ? at.before : at.after;
        start = {0.0, std::abs(glm::dot(ray.direction, n)), owner, n};
    }
}

std::string to_string(const Path& path) {
    const auto name = [](int body) { return body == kOutside ? std::string("air") : fmt::format("{}", body); };
    std::string text = path.events.empty() ? "no interface" : name(path.events.front().before);
    for (const Event& e : path.events) {
        text += e.total ? fmt::format(" |{}| ({:.3f} {:.3f} {:.3f}) {}", name(e.after), e.position.x, e.position.y,
                                      e.position.z, name(e.before))
                        : fmt::format(" ({:.3f} {:.3f} {:.3f}) {}", e.position.x, e.position.y, e.position.z,
                                      name(e.after));
    }
    return text + fmt::format("; out {:.4f} {:.4f} {:.4f}, T {:.3f} {:.3f} {:.3f}{}", path.direction.x,
                              path.direction.y, path.direction.z, path.transmittance.r, path.transmittance.g,
                              path.transmittance.b, path.cut ? ", cut" : "");
}

}  // namespace pellucid::closed_form
