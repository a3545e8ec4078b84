#pragma once

#include "viewer/script.h"
#include "viewer/viewer.h"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::viewer {

/// Runs a script in a viewer, between turns of its loop.
class ScriptRunner {
public:
    /// `name`: file name, for messages.
    ScriptRunner(std::vector<ScriptLine> lines, std::string name) : lines_(std::move(lines)), name_(std::move(name)) {}

    /// Runs lines until one must wait. Throws Error naming the line on failure.
    void step(Viewer& viewer);
    bool done() const { return next_ == lines_.size(); }

private:
    bool run(const ScriptLine& line, Viewer& viewer);
    bool waited(const ScriptLine& line, Viewer& viewer);

    std::vector<ScriptLine> lines_;
    std::string name_;
    std::size_t next_ = 0;
    std::optional<std::uint64_t> waits_for_frame_;
    std::optional<std::chrono::steady_clock::time_point> waits_until_;
    int turns_ = 0;  ///< turns that the current line has waited
};

}  // namespace pellucid::viewer
