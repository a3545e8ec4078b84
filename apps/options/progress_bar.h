#pragma once

#include <pellucid/progress.h>

#include <string>

namespace pellucid::cli {

/// One line on stderr that is drawn over, where stderr is a terminal; nothing elsewhere.
class ProgressBar {
public:
    explicit ProgressBar(std::string label);
    ~ProgressBar() { clear(); }
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// For the functions that report progress; the bar must outlive it.
    Progress progress();
    void show(double share);
    void set_label(std::string label) { label_ = std::move(label); }
    /// Leaves the line as if nothing had been there.
    void clear();

private:
    std::string label_;
    bool terminal_;
    int shown_percent_ = -1;
};

}  // namespace pellucid::cli
