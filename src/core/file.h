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

/// The first `count` bytes of a regular file, fewer if it is shorter; none if it cannot be read.
std::vector<std::byte> first_bytes(const std::filesystem::path& file, std::size_t count);

}  // namespace pellucid
