#pragma once

#include "core/fail.h"

#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

namespace pellucid {

/// Collects Scene::warnings: unique lines in order of appearance.
class Warnings {
public:
    void add(std::string_view text) {
        std::string line = one_line(text);
        if (seen_.insert(line).second) lines_.push_back(std::move(line));
    }
    /// Removes lines that begin with `start` and contain `part`, because they no longer apply.
    void drop(std::string_view start, std::string_view part) {
        std::erase_if(lines_, [&](const std::string& line) {
            return line.starts_with(start) && line.find(part) != std::string::npos;
        });
    }
    const std::vector<std::string>& lines() const { return lines_; }

private:
    std::vector<std::string> lines_;
    std::unordered_set<std::string> seen_;
};

}  // namespace pellucid
