#include "options/unread_scenes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>

namespace pellucid::cli {

void UnreadScenes::add(const std::string& name, const std::string& error) {
    names_.push_back(name);
    errors_.push_back(fmt::format("left out: {}", error));
    std::fputs(fmt::format("pellucid: left out: {}\n", error).c_str(), stderr);
}

void UnreadScenes::finish() const {
    if (names_.empty()) return;
    const std::string of = scenes_ > 0 ? fmt::format(" of {}", scenes_) : std::string();
    throw Error(fmt::format("{}{} scenes could not be read: {}", names_.size(), of, fmt::join(names_, ", ")));
}

}  // namespace pellucid::cli
