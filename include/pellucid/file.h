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

/// Throws Error naming `file` if it certainly cannot be written: its folder is missing or read-only, or a folder or
/// device has that name. Call it before long work.
PELLUCID_API void check_writable(const std::filesystem::path& file);

/// Lets `write` make a new file under the temporary name it is given (same folder, same extension)
/// and then renames it to `file`, so that a killed run leaves no half-written file. Where `file` is a
/// symbolic link to a file, that file is replaced.
/// Throws Error naming `file` if that fails; the temporary file is removed.
PELLUCID_API void write_file_atomically(const std::filesystem::path& file,
                                        const std::function<void(const std::filesystem::path& temporary)>& write);

/// Writes `text` as write_file_atomically() does.
PELLUCID_API void write_text_file(const std::filesystem::path& file, std::string_view text);

}  // namespace pellucid
