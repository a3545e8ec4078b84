#pragma once

#include "core/fail.h"

#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

namespace pellucid {

/// What Scene::warnings is collected in: one line each, each line once, in order of appearance.
class Warnings {
public:
    void add(std::string_view text) {
        std::string line = one_line(text);
        if (seen_.insert(line).second) lines_.push_back(std::move(line));
    }
    const std::vector<std::string>& lines() const { return lines_; }

private:
    std::vector<std::string> lines_;
    std::unordered_set<std::string> seen_;
};

}  // namespace pellucid
