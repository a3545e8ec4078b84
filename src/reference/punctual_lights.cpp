#include "reference/punctual_lights.h"

#include "reference/local_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pellucid::reference {
namespace {

using std::numbers::pi;

bool is_sun(const Light& light) { return light.kind == Light::Kind::kDirectional; }
glm::dvec3 axis_of(const Light& light) { return glm::normalize(glm::dvec3(light.direction)); }

/// Distance, m, at which a ray enters a light's ball; negative if it misses.
double entry(const Light& light, const glm::dvec3& origin, const glm::dvec3& direction) {
    const glm::dvec3 to_center = glm::dvec3(light.position) - origin;
    const double along = glm::dot(to_center, direction), radius = double(light.radius);
    const glm::dvec3 aside = to_center - along * direction;
    const double half_chord2 = radius * radius - glm::dot(aside, aside);
    return half_chord2 > 0.0 ? along - std::sqrt(half_chord2) : -1.0;
}

/// 1 - cos of half the angle that a lamp's ball subtends; empty for a position inside.
std::optional<double> one_less_cosine_from(const Light& lamp, const glm::dvec3& position) {
    const double sine = double(lamp.radius) / glm::length(glm::dvec3(lamp.position) - position);
    if (!(sine < 1.0)) return std::nullopt;
    const double sine2 = sine * sine;
    return sine2 / (1.0 + std::sqrt(1.0 - sine2));
}

double density_in_cone(double one_less_cosine) { return 1.0 / (2.0 * pi * one_less_cosine); }

ArrivingLight arriving_from_disc(const Light& sun, double size, Random& random) {
    const glm::dvec3 in_cone = uniform_in_cone(size, random.next2());
    return {glm::normalize(world_from_local(-axis_of(sun)) * in_cone), std::numeric_limits<double>::infinity(),
            glm::dvec3(sun.intensity), density_in_cone(size)};
}

ArrivingLight arriving_from_ball(const Light& lamp, double size, const glm::dvec3& position, Random& random) {
    const glm::dvec3 to_light = glm::dvec3(lamp.position) - position;
    ArrivingLight arriving;
    arriving.direction =
        glm::normalize(world_from_local(glm::normalize(to_light)) * uniform_in_cone(size, random.next2()));
    arriving.pdf = density_in_cone(size);
    // By rounding, a ray to the rim can miss the ball. The rim lies at the tangent's length.
    const double radius = double(lamp.radius), distance = entry(lamp, position, arriving.direction);
    arriving.distance = distance > 0.0 ? distance : std::sqrt(glm::dot(to_light, to_light) - radius * radius);
    arriving.irradiance = radiance_of(lamp, arriving.direction) * (range_share(lamp, arriving.distance) / arriving.pdf);
    return arriving;
}

}  // namespace

bool has_size(const Light& light) { return (is_sun(light) ? light.angular_diameter : light.radius) > 0.0f; }

double one_less_cosine(const Light& light) {
    const double sine = std::sin(0.25 * double(light.angular_diameter));
    return 2.0 * sine * sine;
}

glm::dvec3 uniform_in_cone(double one_less_cosine, const glm::dvec2& u) {
    const double less = u.x * one_less_cosine, across = std::sqrt(less * (2.0 - less)), angle = 2.0 * pi * u.y;
    return {across * std::cos(angle), across * std::sin(angle), 1.0 - less};
}

double cone_share(const Light& light, double cos_angle) {
    const double cos_inner = std::cos(double(light.inner_cone_angle));
    const double cos_outer = std::cos(double(light.outer_cone_angle));
    if (cos_angle <= cos_outer) return 0.0;
    if (cos_angle >= cos_inner) return 1.0;
    const double ramp = (cos_angle - cos_outer) / (cos_inner - cos_outer);
    return ramp * ramp;
}

double range_share(const Light& light, double distance) {
    const double relative = distance / double(light.range);
    return std::clamp(1.0 - relative * relative * relative * relative, 0.0, 1.0);
}

glm::dvec3 radiance_of(const Light& light, const glm::dvec3& direction) {
    if (is_sun(light)) return glm::dvec3(light.intensity) / (2.0 * pi * one_less_cosine(light));
    const double share =
        light.kind == Light::Kind::kSpot ? cone_share(light, -glm::dot(direction, axis_of(light))) : 1.0;
    return glm::dvec3(light.intensity) * (share / (pi * double(light.radius) * double(light.radius)));
}

double arriving_pdf(const Light& light, const glm::dvec3& position) {
    if (is_sun(light)) return density_in_cone(one_less_cosine(light));
    const std::optional<double> size = one_less_cosine_from(light, position);
    return size ? density_in_cone(*size) : 0.0;
}

std::optional<ArrivingLight> arriving_from_center(const Light& light, const glm::dvec3& position) {
    if (is_sun(light))
        return ArrivingLight{-axis_of(light), std::numeric_limits<double>::infinity(), glm::dvec3(light.intensity)};
    const glm::dvec3 to_light = glm::dvec3(light.position) - position;
    ArrivingLight arriving;
    arriving.distance = glm::length(to_light);
    if (!(arriving.distance > 0.0)) return std::nullopt;
    arriving.direction = to_light / arriving.distance;
    double share = range_share(light, arriving.distance);
    if (light.kind == Light::Kind::kSpot) share *= cone_share(light, -glm::dot(arriving.direction, axis_of(light)));
    if (!(share > 0.0)) return std::nullopt;
    arriving.irradiance = glm::dvec3(light.intensity) * (share / (arriving.distance * arriving.distance));
    return arriving;
}

std::optional<ArrivingLight> arriving_light(const Light& light, const glm::dvec3& position, Random& random) {
    if (!has_size(light)) return arriving_from_center(light, position);
    if (is_sun(light)) return arriving_from_disc(light, one_less_cosine(light), random);
    const std::optional<double> size = one_less_cosine_from(light, position);
    if (!size) return std::nullopt;
    const ArrivingLight arriving = arriving_from_ball(light, *size, position, random);
    if (arriving.irradiance == glm::dvec3(0.0)) return std::nullopt;
    return arriving;
}

SizedLights::SizedLights(std::span<const Light> lights) {
    for (const Light& light : lights) {
        if (has_size(light)) (is_sun(light) ? suns_ : balls_).push_back(&light);
    }
}

SizedLights::Ball SizedLights::nearest(const Query& query, const Light* but) const {
    Ball found{nullptr, query.t_max};
    for (const Light* light : balls_) {
        const double t = entry(*light, query.origin, query.direction);
        if (light != but && t > 0.0 && t < found.t) found = {light, t};
    }
    return found;
}

Hit SizedLights::intersect(const Geometry& geometry, const Query& query, const Light*& ball) const {
    Hit hit = geometry.intersect(query);
    ball = nullptr;
    if (balls_.empty()) return hit;
    Query before = query;
    if (hit.found) before.t_max = hit.t;
    const Ball nearer = nearest(before);
    if (!nearer.light) return hit;
    ball = nearer.light;
    hit = {};
    hit.found = true;
    hit.t = nearer.t;
    hit.position = query.origin + nearer.t * query.direction;
    return hit;
}

bool SizedLights::shows(const Light& sun, const glm::dvec3& direction) {
    // |d + axis|^2 = 2 (1 - cos) stays exact for small angles.
    const glm::dvec3 apart = direction + axis_of(sun);
    return 0.5 * glm::dot(apart, apart) <= one_less_cosine(sun);
}

}  // namespace pellucid::reference
