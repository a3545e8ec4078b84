#pragma once

#include <pellucid/file.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace pellucid {

/// Size of a file in bytes. Throws Error naming the file and the cause if it is missing, a folder, or unreadable.
/// Libraries that read it would only report "could not open".
std::uintmax_t check_readable(const std::filesystem::path& file);

/// Content of a file. Throws Error naming the file if it is missing, a folder, or unreadable.
std::vector<std::byte> read_file(const std::filesystem::path& file);

}  // namespace pellucid
