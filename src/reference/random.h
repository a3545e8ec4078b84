#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace pellucid::reference {

/// Random numbers of one path. The n-th number is a hash of (seed, pixel, sample, n), so an image does not depend on
/// the assignment of paths to threads. SplitMix64 (Steele, Lea & Flood, "Fast splittable pseudorandom number
/// generators", 2014, figure 16), seeded by a separate hash for every path.
class Random {
public:
    Random(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample)
        : state_(mixed(mixed(mixed(seed + kStep) + pixel * kStep) + sample * kStep)) {}

    /// 0 <= x < 1, uniform, 53 bits.
    double next() {
        state_ += kStep;
        return double(mixed(state_) >> 11) * 0x1p-53;
    }
    glm::dvec2 next2() {
        const double x = next();
        return {x, next()};
    }

private:
    static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15;  // 2^64 / golden ratio, odd

    static constexpr std::uint64_t mixed(std::uint64_t x) {
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
        x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
        return x ^ (x >> 31);
    }

    std::uint64_t state_;
};

}  // namespace pellucid::reference
