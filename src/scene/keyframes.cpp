// Interpolation of keyframes (Khronos Group, glTF 2.0 Specification, 2021, section 3.11 and appendix C).
#include "scene/keyframes.h"

#include <algorithm>

namespace pellucid {
namespace {

/// Position of a time between two keys.
struct Place {
    std::size_t key = 0;    ///< the key before the time, or the only relevant key
    double u = 0.0;         ///< 0..1 between this key and the next; 0: only `key` matters
    double length_s = 0.0;  ///< time between this key and the next
};

Place place_of(const Keyframes& k, double time_s) {
    // Of several keys at one time the last applies. Intervals in use therefore never have length 0.
    const auto next = std::upper_bound(k.times.begin(), k.times.end(), time_s,
                                       [](double time, float key_time) { return time < double(key_time); });
    if (next == k.times.begin()) return {};
    Place place{.key = std::size_t(next - k.times.begin()) - 1};
    if (next == k.times.end() || k.interpolation == Interpolation::kStep) return place;
    place.length_s = double(*next) - double(k.times[place.key]);
    place.u = (time_s - double(k.times[place.key])) / place.length_s;
    return place;
}

/// `part`: 0 the tangent before the key, 1 the value, 2 the tangent after the key.
double number(const Keyframes& k, std::size_t key, std::size_t part, std::size_t component) {
    const std::size_t row = k.interpolation == Interpolation::kCubicSpline ? 3 * key + part : key;
    return double(k.values[row * k.width + component]);
}

double cubic(const Keyframes& k, const Place& p, std::size_t c) {
    const double u = p.u, u2 = u * u, u3 = u2 * u;
    return (2 * u3 - 3 * u2 + 1) * number(k, p.key, 1, c) + p.length_s * (u3 - 2 * u2 + u) * number(k, p.key, 2, c) +
           (-2 * u3 + 3 * u2) * number(k, p.key + 1, 1, c) + p.length_s * (u3 - u2) * number(k, p.key + 1, 0, c);
}

glm::dquat quaternion(const Keyframes& k, std::size_t key) {
    return {number(k, key, 1, 3), number(k, key, 1, 0), number(k, key, 1, 1), number(k, key, 1, 2)};
}

}  // namespace

std::vector<double> value_at(const Keyframes& k, double time_s) {
    const Place p = place_of(k, time_s);
    std::vector<double> value(k.width);
    for (std::size_t c = 0; c < k.width; ++c) {
        const double here = number(k, p.key, 1, c);
        if (p.u == 0.0) {
            value[c] = here;
        } else if (k.interpolation == Interpolation::kCubicSpline) {
            value[c] = cubic(k, p, c);
        } else {
            value[c] = here + p.u * (number(k, p.key + 1, 1, c) - here);
        }
    }
    return value;
}

glm::dquat rotation_at(const Keyframes& k, double time_s) {
    const Place p = place_of(k, time_s);
    const glm::dquat here = glm::normalize(quaternion(k, p.key));
    if (p.u == 0.0) return here;
    if (k.interpolation == Interpolation::kLinear)
        return glm::normalize(glm::slerp(here, glm::normalize(quaternion(k, p.key + 1)), p.u));
    const glm::dquat spline(cubic(k, p, 3), cubic(k, p, 0), cubic(k, p, 1), cubic(k, p, 2));
    // A spline between opposite quaternions may pass through zero, which is no rotation.
    return glm::length(spline) > 0.0 ? glm::normalize(spline) : here;
}

}  // namespace pellucid
