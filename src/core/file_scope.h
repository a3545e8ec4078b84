#pragma once

#include <filesystem>

namespace pellucid {

inline constexpr const char* kOutsideScope = "lies outside the scene's folder; --allow-outside permits that";

/// The files that a scene file may name.
struct FileScope {
    std::filesystem::path folder;  ///< of the scene file
    bool allow_outside = false;

    /// Whether a file or folder is allowed: it lies in the folder or below it, after links and ".." are resolved.
    bool contains(const std::filesystem::path& file) const;
    /// Throws Error naming `file` if it is not allowed.
    void check(const std::filesystem::path& file) const;
};

}  // namespace pellucid
