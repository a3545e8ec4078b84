#include "options/progress_bar.h"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace pellucid::cli {

ProgressBar::ProgressBar(std::string label) : label_(std::move(label)), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress ProgressBar::progress() {
    return [this](double share) { show(share); };
}

void ProgressBar::show(double share) {
    if (!terminal_) return;
    const int percent = int(100.0 * std::clamp(share, 0.0, 1.0));
    if (percent == shown_percent_) return;
    shown_percent_ = percent;
    constexpr int kWidth = 30;
    const int filled = percent * kWidth / 100;
    std::fputs(fmt::format("\r\x1b[K{} [{:#<{}}{:.<{}}] {}%", label_, "", filled, "", kWidth - filled, percent).c_str(),
               stderr);
}

void ProgressBar::clear() {
    if (shown_percent_ >= 0) std::fputs("\r\x1b[K", stderr);
    shown_percent_ = -1;
}

}  // namespace pellucid::cli
