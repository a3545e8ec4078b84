#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pellucid {

/// `text` with every run of white space and control characters as one blank: messages of other
/// libraries and names inside files may hold line breaks, ours are one line.
std::string one_line(std::string_view text);

/// Throws Error "FILE: CAUSE", in one line.
[[noreturn]] void fail(const std::filesystem::path& file, std::string_view cause);

}  // namespace pellucid
