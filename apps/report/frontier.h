#pragma once

#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// Speed and accuracy of a technique.
struct Performance {
    double time_ms = 0.0;   ///< time of a frame, above 0
    double accuracy = 0.0;  ///< 0..1
};

/// A technique's measurements: one for each scene and view that has a time.
struct TechniquePerformance {
    std::string name;  ///< valid UTF-8
    std::vector<Performance> runs;

    /// Arithmetic mean over the runs; empty without runs.
    std::optional<Performance> mean() const;
};

/// Indices of the Pareto-optimal elements, by ascending time: no other element is at least as fast and as accurate,
/// and better in one of both.
std::vector<std::size_t> pareto_frontier(const std::vector<Performance>& candidates);

/// The plot as a complete SVG document, for a page or a file. Time is horizontal and logarithmic. Accuracy is
/// vertical, with a logarithmic remaining share: 90 to 99% is as far as 99 to 99.9%. Small marks show runs, large
/// marks means, and a line the frontier of the means. Empty if no technique has a time. `accuracy_name`: label of the
/// accuracy.
std::string frontier_svg(const std::vector<TechniquePerformance>& techniques, const std::string& accuracy_name);

}  // namespace pellucid
