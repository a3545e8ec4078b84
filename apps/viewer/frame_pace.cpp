#include "viewer/frame_pace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace pellucid::viewer {
namespace {

constexpr std::array<float, 7> kScales{1.0f, 0.75f, 0.5f, 0.375f, 0.25f, 0.1875f, 0.125f};
/// Smaller scales lose details of glass; then a faster technique at a larger scale shows more.
constexpr float kLeastOwnScale = 0.375f;
/// Frames that must agree before a larger scale is tried. A scale that was too slow is thus not retried in every
/// frame.
constexpr std::size_t kCalmFrames = 6;
/// Largest expected share of the target time at a larger scale.
constexpr double kMargin = 0.85;

double cost(float from, float to) { return double(to) * double(to) / (double(from) * double(from)); }

}  // namespace

void FramePace::restart(bool has_coarse) {
    has_coarse_ = has_coarse;
    go({.scale = 0.5f});
}

void FramePace::go(Pace pace) {
    if (!(pace == pace_)) ++changes_;
    pace_ = pace;
    times_ms_.clear();
}

double FramePace::median_ms() const {
    if (times_ms_.empty()) return 0.0;
    std::vector<double> sorted(times_ms_.begin(), times_ms_.end());
    const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
}

void FramePace::measured(double frame_ms) {
    times_ms_.push_back(frame_ms);
    if (times_ms_.size() > kCalmFrames) times_ms_.pop_front();
    const double ms = median_ms();
    // One slow frame may have compiled shaders; two of three have not.
    if (times_ms_.size() >= 3 && ms > target_ms_) {
        const auto fits = [&](float scale) {
            return scale < pace_.scale && ms * cost(pace_.scale, scale) <= target_ms_;
        };
        const auto smaller = std::find_if(kScales.begin(), kScales.end(), fits);
        const float scale = smaller == kScales.end() ? kScales.back() : *smaller;
        if (!pace_.coarse && has_coarse_ && scale < kLeastOwnScale)
            go({.scale = 0.5f, .coarse = true});
        else if (scale != pace_.scale)
            go({.scale = scale, .coarse = pace_.coarse});
    } else if (times_ms_.size() >= kCalmFrames && pace_.scale < 1.0f) {
        const float larger = *std::prev(std::find(kScales.begin(), kScales.end(), pace_.scale));
        if (ms * cost(pace_.scale, larger) <= kMargin * target_ms_) go({.scale = larger, .coarse = pace_.coarse});
    }
}

std::uint32_t scaled(std::uint32_t size, float scale) {
    return std::max(1u, std::uint32_t(std::lround(double(size) * double(scale))));
}

}  // namespace pellucid::viewer
