#pragma once

#include "options/console.h"

#include <pellucid/progress.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace pellucid::cli {

/// "LABEL [###...] 42%, 12 s left" of work whose share is known, or "LABEL, 5 s". `share_s`: how long the share took.
std::string progress_line(const std::string& label, std::optional<double> share, double share_s, double elapsed_s);

/// One step of a command. Where stderr is a terminal, a line that is drawn over shows its progress once it has taken two
/// seconds. With --verbose a line with its time follows when it is done.
class ProgressBar {
public:
    ProgressBar(const Console& console, std::string label);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// For the functions that report progress; the bar must outlive it.
    Progress progress();
    void show(double share);
    /// Ends the step, and leaves the line as if nothing had been there.
    void clear();

private:
    using Clock = std::chrono::steady_clock;
    void draw_until_stopped();

    const Console& console_;
    const Clock::time_point begin_ = Clock::now();
    std::mutex mutex_;  ///< for what follows
    std::condition_variable stopped_;
    std::string label_;
    std::optional<double> share_;
    Clock::time_point share_begin_ = begin_;  ///< when `share_` was last 0
    bool done_ = false;
    std::thread drawing_;  ///< where stderr is a terminal
};

}  // namespace pellucid::cli
