#pragma once

#include <pellucid/api.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace pellucid {

/// Extension of a file in lower case, with its dot.
inline std::string lower_extension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

/// Throws Error naming `file` if it cannot be written: its folder is missing or read-only, or a folder or device has
/// that name. Call it before long work.
PELLUCID_API void check_writable(const std::filesystem::path& file);

/// Calls `write` with a temporary name (same folder, same extension), then renames the temporary file to `file`. A
/// killed run thus leaves no half-written file. If `file` is a symbolic link to a file, the target is replaced. Throws
/// Error naming `file` on failure and removes the temporary file.
PELLUCID_API void write_file_atomically(const std::filesystem::path& file,
                                        const std::function<void(const std::filesystem::path& temporary)>& write);

/// Writes `text` as write_file_atomically() does.
PELLUCID_API void write_text_file(const std::filesystem::path& file, std::string_view text);

}  // namespace pellucid
