#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace pellucid {

/// A folder that contains files of a report among others. The list kList in it names the report's files, so that the
/// next report replaces these and no others. Each name is listed before its file is written. A killed run thus leaves
/// no unlisted file.
class ReportFolder {
public:
    static constexpr const char* kList = "pellucid-report.txt";

    /// Creates `path` and its parents if missing. Removes the files of an older list, in its order. Throws Error
    /// naming the file on failure, or if a file called kList is not such a list.
    explicit ReportFolder(const std::filesystem::path& path);

    /// Lists `name` ('/' separates folders, which are created) and returns its path. Throws Error if a file of that
    /// name exists that is not the report's.
    std::filesystem::path claim(const std::string& name);

    /// Path of `name`.
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

    /// True if `name` exists in the folder.
    bool has(const std::string& name) const;

private:
    std::filesystem::path path_;
    std::ofstream list_;
};

}  // namespace pellucid
