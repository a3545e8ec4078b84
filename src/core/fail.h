#pragma once

#include <pellucid/error.h>

#include <filesystem>
#include <string_view>

namespace pellucid {

/// Throws Error "FILE: CAUSE" in one line.
[[noreturn]] void fail(const std::filesystem::path& file, std::string_view cause);

}  // namespace pellucid
