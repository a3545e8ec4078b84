#pragma once

#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// How fast and how right a technique was.
struct Performance {
    double time_ms = 0.0;   ///< of a frame, above 0
    double accuracy = 0.0;  ///< 0..1
};

/// A technique's measurements: one for each scene and view that has a time.
struct TechniquePerformance {
    std::string name;  ///< valid UTF-8
    std::vector<Performance> runs;

    /// Arithmetic mean over the runs; none without runs.
    std::optional<Performance> mean() const;
};

/// Indices of the elements that no other beats: none is at least as fast and as accurate, and better in one.
/// By rising time.
std::vector<std::size_t> pareto_frontier(const std::vector<Performance>& candidates);

/// The plot as a complete SVG document, for a page or a file: time across (logarithmic), accuracy up (the remaining
/// share is logarithmic, as 99 and 99.9% differ as much as 90 and 99%), small marks for runs, large ones for means,
/// and the frontier of the means. Empty if no technique has a time. `accuracy_name` says what accuracy is.
std::string frontier_svg(const std::vector<TechniquePerformance>& techniques, const std::string& accuracy_name);

}  // namespace pellucid
