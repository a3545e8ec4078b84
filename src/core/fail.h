#pragma once

#include <pellucid/error.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace pellucid {

/// Throws Error "FILE: CAUSE" in one line.
[[noreturn]] void fail(const std::filesystem::path& file, std::string_view cause);

/// The first 60 characters of a word of the input, without control characters: for a message.
std::string shortened(std::string_view text);

}  // namespace pellucid
