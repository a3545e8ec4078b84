#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

namespace pellucid::viewer {

/// How the next frame is drawn while something moves.
struct Pace {
    float scale = 1.0f;   ///< of width and height, 0 to 1
    bool coarse = false;  ///< by the preset `fast`, whatever technique was chosen
    bool operator==(const Pace&) const = default;
};

/// Chooses resolution and technique from the times of the frames before, so that frames keep a rate. Frame times are taken to
/// grow with the number of pixels, less than in proportion.
class FramePace {
public:
    explicit FramePace(double target_ms = 50.0) : target_ms_(target_ms) {}

    /// `has_coarse`: there is a faster technique than the chosen one.
    void restart(bool has_coarse);
    /// A frame that was drawn at pace() took so long.
    void measured(double frame_ms);
    Pace pace() const { return pace_; }
    std::uint64_t changes() const { return changes_; }  ///< of the pace so far
    double median_ms() const;

private:
    void go(Pace pace);

    double target_ms_;
    bool has_coarse_ = false;
    Pace pace_{.scale = 0.5f};
    std::uint64_t changes_ = 0;
    std::deque<double> times_ms_;  ///< of the last frames at this pace
};

/// Pixels along a side of `size` at this scale, at least 1.
std::uint32_t scaled(std::uint32_t size, float scale);

}  // namespace pellucid::viewer
