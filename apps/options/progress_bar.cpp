#include "options/progress_bar.h"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace pellucid::cli {
namespace {

constexpr auto kBeforeShown = std::chrono::seconds(2);
constexpr auto kBetweenLines = std::chrono::milliseconds(200);

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::string duration(double seconds) {
    const long whole = std::lround(std::max(seconds, 0.0));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

}  // namespace

std::string progress_line(const std::string& label, std::optional<double> share, double share_s, double elapsed_s) {
    if (!share) return fmt::format("{}, {}", label, duration(elapsed_s));
    constexpr int kWidth = 30;
    constexpr double kLeastShare = 0.01;  // before, the time left is a guess
    const double done = std::clamp(*share, 0.0, 1.0);
    const int filled = int(done * kWidth);
    return fmt::format("{} [{:#<{}}{:.<{}}] {}%{}", label, "", filled, "", kWidth - filled, int(100.0 * done),
                       done < kLeastShare ? "" : fmt::format(", {} left", duration(share_s / done * (1.0 - done))));
}

ProgressBar::ProgressBar(const Console& console, std::string label) : console_(console), label_(std::move(label)) {
    if (!console.quiet && isatty(STDERR_FILENO) == 1) drawing_ = std::thread([this] { draw_until_stopped(); });
}

ProgressBar::~ProgressBar() { clear(); }

Progress ProgressBar::progress() {
    return [this](double share) { show(share); };
}

void ProgressBar::show(double share) {
    const std::lock_guard lock(mutex_);
    // Another part of the work begins at 0 again.
    if (!share_ || share < *share_) share_begin_ = Clock::now();
    share_ = share;
}

void ProgressBar::clear() {
    {
        const std::lock_guard lock(mutex_);
        if (done_) return;
        done_ = true;
    }
    stopped_.notify_all();
    if (drawing_.joinable()) drawing_.join();
    console_.report(fmt::format("{}: {:.2f} s", label_, seconds_since(begin_)));
}

void ProgressBar::draw_until_stopped() {
    std::unique_lock lock(mutex_);
    const auto done = [this] { return done_; };
    bool shown = false;
    for (auto wait = std::chrono::milliseconds(kBeforeShown); !stopped_.wait_for(lock, wait, done);
         wait = kBetweenLines) {
        const std::string line = progress_line(label_, share_, seconds_since(share_begin_), seconds_since(begin_));
        std::fputs(fmt::format("\r\x1b[K{}", line).c_str(), stderr);
        shown = true;
    }
    if (shown) std::fputs("\r\x1b[K", stderr);
}

}  // namespace pellucid::cli
