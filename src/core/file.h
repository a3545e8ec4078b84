#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

namespace pellucid {

/// Size of a file in bytes. Throws Error naming it if it is missing, a folder, or unreadable: what a library that reads
/// it would only report as "could not open", said precisely.
std::uintmax_t check_readable(const std::filesystem::path& file);

/// Whole content of a file. Throws Error naming it if it is missing, a folder, or unreadable.
std::vector<std::byte> read_file(const std::filesystem::path& file);

/// Throws Error naming `file` if it is already clear that it cannot be written: no such folder, no right to
/// write there, a folder or device of that name. For saying so before long work.
void check_writable(const std::filesystem::path& file);

/// Lets `write` make a new file under the temporary name it is given (same folder, same extension)
/// and then renames it to `file`, so that a killed run leaves no half-written file. Where `file` is a
/// symbolic link to a file, that file is replaced.
/// Throws Error naming `file` if that fails; the temporary file is removed.
void write_file_atomically(const std::filesystem::path& file,
                           const std::function<void(const std::filesystem::path& temporary)>& write);

/// As above for text that is at hand.
void write_text_file(const std::filesystem::path& file, std::string_view text);

}  // namespace pellucid
