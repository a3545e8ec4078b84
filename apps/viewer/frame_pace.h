#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

namespace pellucid::viewer {

/// Settings of the next frame during motion.
struct Pace {
    float scale = 1.0f;   ///< factor of width and height, 0 to 1
    bool coarse = false;  ///< use the preset `fast` instead of the chosen technique
    bool operator==(const Pace&) const = default;
};

/// Chooses resolution and technique from previous frame times, to hold a frame rate. It assumes that frame time grows
/// at most in proportion to the number of pixels.
class FramePace {
public:
    explicit FramePace(double target_ms = 50.0) : target_ms_(target_ms) {}

    /// Starts again. `has_coarse`: there is a technique faster than the chosen one.
    void restart(bool has_coarse);
    /// Reports the time of a frame drawn at pace().
    void measured(double frame_ms);
    Pace pace() const { return pace_; }
    std::uint64_t changes() const { return changes_; }  ///< number of changes of the pace so far
    double median_ms() const;

private:
    void go(Pace pace);

    double target_ms_;
    bool has_coarse_ = false;
    Pace pace_{.scale = 0.5f};
    std::uint64_t changes_ = 0;
    std::deque<double> times_ms_;  ///< times of the last frames at this pace
};

/// Pixels along a side of `size` at this scale, at least 1.
std::uint32_t scaled(std::uint32_t size, float scale);

}  // namespace pellucid::viewer
