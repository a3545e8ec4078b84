#pragma once

#include <pellucid/file.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace pellucid {

/// Size of a file in bytes. Throws Error naming it if it is missing, a folder, or unreadable: what a library that reads
/// it would only report as "could not open", said precisely.
std::uintmax_t check_readable(const std::filesystem::path& file);

/// Whole content of a file. Throws Error naming it if it is missing, a folder, or unreadable.
std::vector<std::byte> read_file(const std::filesystem::path& file);

}  // namespace pellucid
